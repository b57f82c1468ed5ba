/* Blocks that end with a value: what a jump brings to the join is not what comes there by itself. */
void w2c_h_exits_value(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  FUNC_PROLOGUE;
  u32 var_i0, var_i1, var_i2;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance);
  var_i0 = 5u;
  var_i1 = 6u;
  var_i2 = var_l0 & 1u;
  if (var_i2) {goto var_B1;}
  var_i2 = var_l0 & 2u;
  if (var_i2) {var_i0 = var_i1; goto var_B0;}
  var_i1 = 9u;
  var_B1:;
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_i1 == ((var_l0 & 1u) ? 6u : 9u));
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_i1 != 9u); /* false */
  var_i0 += var_i1;
  var_B0:;
  var_l1 = var_i0;
  w2c_prover_claim(instance->w2c_prover_instance, 2u, var_l1 == 11u || var_l1 == 6u || var_l1 == 14u);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, (var_l1 == 6u) == ((var_l0 & 3u) == 2u));
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l1 != 6u); /* false */
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l1 != 14u); /* false */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 11u);
  FUNC_EPILOGUE;
}
