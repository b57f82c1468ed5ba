/* A loop with a conditional jump back in its middle, and a way out over what follows that jump, which the second round
   takes for certain. No compiler can be made to write it. proofs/runner/src/loops.rs says what CBMC makes of it. */
void w2c_h_loops(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  FUNC_PROLOGUE;
  u32 var_i0, var_i1;
  var_l1 = w2c_prover_word(instance->w2c_prover_instance);
  var_L1: 
    if (var_l0) {goto var_B0;}
    var_l0 = 1u;
    var_i0 = var_l1 & 1u;
    if (var_i0) {goto var_L1;}
    /* Only with an even value. */
    w2c_prover_claim(instance->w2c_prover_instance, 0u, (var_l1 & 1u) == 0u);
    w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l1 != 6u); /* false */
    w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 8u);
    var_i1 = var_l1 & 2u;
    if (var_i1) {goto var_L1;}
    w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_l1 & 3u) == 0u);
  var_B0:;
  FUNC_EPILOGUE;
}
