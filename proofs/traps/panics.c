/* Two jumps to one panic behind what stands between: the second of them can be taken. */
void w2c_h_panics(w2c_h* instance) {
  u32 var_l0 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance) & 15u;
  var_i0 = var_l0 > 15u;
  if (var_i0) {goto var_B0;}
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l0 == 7u);
  var_i0 = var_l0 == 7u;
  if (var_i0) {goto var_B0;}
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l0 != 7u);
  goto var_B1;
  var_B0:;
  var_i0 = 3u;
  UNREACHABLE;
  var_B1:;
  FUNC_EPILOGUE;
}
