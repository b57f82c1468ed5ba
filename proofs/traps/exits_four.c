/* Four blocks within each other, with jumps from the innermost to each of the four joins, and from each join to the
   ones behind it. */
void w2c_h_exits_four(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance) & 63u;
  var_i0 = (var_l0 & 7u) == 1u;
  if (var_i0) {goto var_B3;}
  var_i0 = (var_l0 & 7u) == 2u;
  if (var_i0) {goto var_B2;}
  var_i0 = (var_l0 & 7u) == 3u;
  if (var_i0) {goto var_B1;}
  var_i0 = (var_l0 & 7u) == 4u;
  if (var_i0) {goto var_B0;}
  w2c_prover_claim(instance->w2c_prover_instance, 0u, (var_l0 & 7u) == 0u || (var_l0 & 7u) > 4u);
  var_l1 = 1u;
  var_B3:;
  w2c_prover_claim(instance->w2c_prover_instance, 1u, (var_l0 & 7u) - 2u > 2u);
  var_i0 = var_l0 >= 56u;
  if (var_i0) {goto var_B0;}
  var_l1 += 2u;
  var_B2:;
  w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_l0 & 7u) == 2u || var_l0 < 56u);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l0 != 58u); /* false: straight from the innermost */
  var_i0 = var_l0 < 8u;
  if (var_i0) {goto var_B0;}
  var_l1 += 4u;
  var_B1:;
  var_i0 = (var_l0 & 7u) == 3u;
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_i0 ? var_l1 == 0u : var_l1 >= 4u && var_l0 >= 8u);
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l1 != 6u); /* false: 1 + 8 n */
  var_l1 += 8u;
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l1 < 16u && (0xd10fu >> var_l1 & 1u)); /* 0 to 3, 8, 12, 14, 15 */
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 != 1u); /* false: 56, over two joins */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 15u);
  w2c_prover_cover(instance->w2c_prover_instance, 1u, var_l1 == 3u);
  w2c_prover_cover(instance->w2c_prover_instance, 2u, var_l1 == 12u);
  w2c_prover_cover(instance->w2c_prover_instance, 3u, var_l0 == 2u && var_l1 == 0u);
  FUNC_EPILOGUE;
}
