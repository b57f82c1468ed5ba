/* Many jumps to one join from different depths, and a region in between that some of them leave from its middle. */
void w2c_h_joins_many(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0, var_l2 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance);
  var_l2 = w2c_prover_word(instance->w2c_prover_instance) & 1u;
  var_i0 = var_l0 == 0u;
  if (var_i0) {goto var_B0;}
  var_l1 = 1u;
  var_i0 = var_l0 & 1u;
  if (var_i0) {goto var_B1;}
  var_l1 = 2u;
  var_i0 = var_l0 & 2u;
  if (var_i0) {goto var_B0;}
  var_l1 = 3u;
  var_i0 = var_l0 & 4u;
  if (var_i0) {goto var_B2;}
  var_l1 = 4u;
  if (var_l2) {goto var_B0;}
  var_l1 = 5u;
  var_B2:;
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l1 == 3u || var_l1 == 5u);
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l1 != 5u || var_l0 != 16u); /* false */
  var_i0 = var_l0 & 8u;
  if (var_i0) {goto var_B0;}
  var_l1 += 8u;
  var_B1:;
  var_i0 = var_l1 == 11u || (var_l1 == 13u && !var_l2);
  w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_l0 & 1u) ? var_l1 == 1u : var_i0);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l1 != 11u); /* false */
  if (var_l2) {goto var_B0;}
  var_l1 += 16u;
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 29u);
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 4u, (var_l1 == 0u) == (var_l0 == 0u));
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l1 != 4u || ((var_l0 & 7u) == 0u && var_l2));
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l1 != 5u); /* false: 8, not 1 */
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 != 1u || var_l0 != 65535u); /* false */
  w2c_prover_cover(instance->w2c_prover_instance, 1u, var_l1 == 17u);
  w2c_prover_cover(instance->w2c_prover_instance, 2u, var_l1 == 2u);
  FUNC_EPILOGUE;
}
