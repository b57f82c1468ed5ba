/* Ways out of a loop within blocks: to the join behind the loop, to the one behind that, and on to the next round. */
void w2c_h_exits_loop(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0, var_l2 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance) & 255u;
  var_L2: 
    var_i0 = var_l1 == 3u;
    if (var_i0) {goto var_B1;}
    var_i0 = (var_l0 >> (var_l1 & 31u)) & 1u;
    var_l1 += 1u;
    if (var_i0) {goto var_B4;}
    var_i0 = (var_l0 >> 4u) == var_l1;
    if (var_i0) {goto var_B3;}
    var_l2 += 1u;
    goto var_L2;
    var_B4:;
    w2c_prover_claim(instance->w2c_prover_instance, 0u, (var_l0 & 7u) != 0u);
    var_i0 = (var_l0 >> 4u) == 15u;
    if (var_i0) {goto var_B0;}
    var_l2 += 4u;
    goto var_L2;
    var_B3:;
    w2c_prover_claim(instance->w2c_prover_instance, 1u, (var_l0 >> 4u) == var_l1 && var_l1 <= 3u);
    w2c_prover_claim(instance->w2c_prover_instance, 2u, var_l2 != 8u); /* false: 3 in the third round, 1 and 1 before */
    var_l2 += 32u;
  var_B1:;
  w2c_prover_claim(instance->w2c_prover_instance, 3u, (var_l0 >> 4u) < 15u || (var_l0 & 7u) == 0u);
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l1 == 3u || var_l2 >= 32u);
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l2 != 12u); /* false: 1, 1, 1 */
  var_l2 += 64u;
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l2 >= 64u || ((var_l0 >> 4u) == 15u && var_l2 <= 2u));
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l2 != 2u); /* false: 15 in the third round */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l2 == 104u);
  FUNC_EPILOGUE;
}
