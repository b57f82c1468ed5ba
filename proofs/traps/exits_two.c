/* Two blocks within each other. Jumps out of the inner one end at the first join or pass over it, by the value. */
void w2c_h_exits_two(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  FUNC_PROLOGUE;
  u32 var_i0, var_i1;
  var_i0 = w2c_prover_word(instance->w2c_prover_instance);
  var_l0 = var_i0;
  var_i1 = 1u;
  var_i0 &= var_i1;
  if (var_i0) {goto var_B1;}
  var_i0 = var_l0;
  var_i1 = 2u;
  var_i0 &= var_i1;
  if (var_i0) {goto var_B0;}
  w2c_prover_claim(instance->w2c_prover_instance, 0u, (var_l0 & 3u) == 0u);
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l0 != 8u); /* false */
  var_l1 = 1u;
  var_B1:;
  w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_l0 & 3u) != 2u);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, (var_l0 & 3u) == 0u); /* false: odd values come here */
  w2c_prover_claim(instance->w2c_prover_instance, 4u, (var_l1 == 1u) == ((var_l0 & 1u) == 0u));
  var_l1 += 2u;
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l1 == ((var_l0 & 1u) ? 2u : (var_l0 & 2u) ? 0u : 3u));
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l1 != 0u); /* false: 2 passes over the first join */
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 != 3u || var_l0 != 12u); /* false */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 2u);
  FUNC_EPILOGUE;
}
