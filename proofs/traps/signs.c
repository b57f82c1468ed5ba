/* Shifts and comparisons as wasm2c writes them: the distance is masked, and a cast to signed decides an order. */
void w2c_h_signs(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  u64 var_l2 = 0;
  FUNC_PROLOGUE;
  u32 var_i0, var_i1;
  u64 var_j0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance) << 16;
  var_l1 = w2c_prover_word(instance->w2c_prover_instance) & 127u;
  var_i0 = var_l0;
  var_i1 = var_l1;
  var_i0 <<= (var_i1 & 31);
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l1 != 33u || var_i0 == var_l0 + var_l0);
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l1 < 32u || var_i0 == 0u); /* false */
  var_i0 = (u32)((s32)var_l0 >> (var_i1 & 31));
  w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_i0 >> 31) == (var_l0 >> 31));
  var_i0 = (u32)((s32)var_l0 < (s32)65536);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_i0 == (var_l0 >= 0x80000000u || var_l0 == 0u));
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_i0 == (var_l0 < 65536u)); /* false */
  var_j0 = (u64)(s64)(s32)(var_l0);
  var_l2 = (u64)(var_l0);
  w2c_prover_claim(instance->w2c_prover_instance, 5u, (u32)(var_j0) == (u32)(var_l2));
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_j0 == var_l2); /* false */
  var_j0 = (u64)((s64)var_j0 >> (40 & 63));
  w2c_prover_claim(instance->w2c_prover_instance, 7u, (u32)(var_j0 >> 32) == ((var_l0 >> 31) ? 0xffffffffu : 0u));
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 127u);
  FUNC_EPILOGUE;
}
