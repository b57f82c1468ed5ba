/* A switch in a loop: one case goes on in the loop, one leaves it, one leaves the block around it. */
void w2c_h_loops_switch(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0, var_l2 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance);
  var_L2: 
    if (var_l1 == 4u) {goto var_B1;}
    var_i0 = (var_l0 >> (var_l1 * 2u & 31u)) & 3u;
    var_l1 += 1u;
    switch (var_i0) {
      case 0: goto var_L2;
      case 1: goto var_B3;
      case 2: goto var_B1;
      default: goto var_B0;
    }
    var_B3:;
    var_l2 += 1u;
    w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l2 <= var_l1);
    w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l2 != 4u); /* false: 1, 1, 1, 1 */
    goto var_L2;
  var_B1:;
  w2c_prover_claim(instance->w2c_prover_instance, 2u, var_l1 == 4u || var_i0 == 2u);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l2 != 0u || var_l1 != 3u); /* false: 0, 0, 2 */
  var_l2 += 16u;
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l2 <= 4u || (var_l2 >= 16u && var_l2 <= 20u));
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l2 != 3u); /* false: 1, 1, 1, 3 */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l2 == 20u);
  FUNC_EPILOGUE;
}
