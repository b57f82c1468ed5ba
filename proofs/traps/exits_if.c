/* Jumps out of both arms of an if, and out of an if within it, over what stands behind them. */
void w2c_h_exits_if(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance);
  var_i0 = var_l0 & 1u;
  if (var_i0) {
    var_i0 = var_l0 & 2u;
    if (var_i0) {
      var_i0 = var_l0 & 4u;
      if (var_i0) {goto var_B0;}
      var_l1 = 1u;
      goto var_B1;
    }
    var_l1 = 2u;
    w2c_prover_claim(instance->w2c_prover_instance, 0u, (var_l0 & 3u) == 1u);
  } else {
    var_i0 = var_l0 & 8u;
    if (var_i0) {goto var_B1;}
    var_l1 = 3u;
    w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l0 != 4u); /* false */
  }
  w2c_prover_claim(instance->w2c_prover_instance, 2u, var_l1 == 2u || var_l1 == 3u);
  var_l1 += 4u;
  var_B1:;
  w2c_prover_claim(instance->w2c_prover_instance, 3u, (var_l0 & 7u) != 7u);
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l1 != 0u); /* false: an even value with 8 */
  var_l1 += 8u;
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 5u, ((var_l0 & 7u) == 7u) == (var_l1 == 0u));
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l1 < 16u && (0xc301u >> var_l1 & 1u)); /* 0, 8, 9, 14, 15 */
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 != 9u); /* false: 3 */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 14u);
  FUNC_EPILOGUE;
}
