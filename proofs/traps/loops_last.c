/* Two loops, one after the other, each with its conditional jump back at its end.
   What follows a loop sees every number of rounds. */
void w2c_h_loops_last(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0, var_l2 = 0;
  FUNC_PROLOGUE;
  u32 var_i0, var_i1;
  var_i0 = w2c_prover_word(instance->w2c_prover_instance);
  var_l0 = var_i0 & 7u;
  var_L0: 
    var_i0 = var_l1;
    var_i0 += 1u;
    var_l1 = var_i0;
    var_i1 = var_l0;
    var_i0 = var_i0 < var_i1;
    if (var_i0) {goto var_L0;}
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l1 >= var_l0 && var_l1 >= 1u);
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l1 != 5u); /* false */
  w2c_prover_claim(instance->w2c_prover_instance, 2u, var_l1 != 1u); /* false: with 0 and with 1 */
  var_L1: 
    var_l2 += 2u;
    var_i0 = var_l2 < var_l1;
    if (var_i0) {goto var_L1;}
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l2 == ((var_l1 + 1u) & ~1u));
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l2 == var_l1); /* false */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l2 == 8u);
  FUNC_EPILOGUE;
}
