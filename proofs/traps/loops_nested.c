/* A loop in a loop: the inner one jumps back to its own beginning and, on a condition, to that of the outer one. */
void w2c_h_loops_nested(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0, var_l2 = 0, var_l3 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance) & 15u;
  var_l3 = w2c_prover_word(instance->w2c_prover_instance) & 3u;
  var_L1: 
    if (var_l1 == 3u) {goto var_B0;}
    var_l1 += 1u;
    var_l2 = 0u;
    var_L2: 
      if (var_l2 == 3u) {goto var_L1;}
      var_i0 = var_l2 == var_l3;
      if (var_i0) {goto var_L1;}
      var_l2 += 1u;
      w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l2 <= var_l3);
      var_i0 = var_l2 != var_l0;
      if (var_i0) {goto var_L2;}
    w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l2 == var_l0 && var_l0 <= var_l3 && var_l0 != 0u);
    w2c_prover_claim(instance->w2c_prover_instance, 2u, var_l0 != 2u); /* false */
    var_i0 = var_l1 & 1u;
    if (var_i0) {goto var_L1;}
    w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l1 == 2u);
    w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l0 != 3u); /* false */
    goto var_B1;
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l0 > var_l3 || var_l0 == 0u);
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l3 != 3u); /* false */
  var_B1:;
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 >= 2u && var_l1 <= 3u);
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 2u);
  w2c_prover_cover(instance->w2c_prover_instance, 1u, var_l1 == 3u);
  FUNC_EPILOGUE;
}
