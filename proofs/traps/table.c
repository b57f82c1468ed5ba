/* A jump table out of three blocks: each case ends at its own join and runs on through those behind it. */
void w2c_h_table(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance);
  var_i0 = var_l0;
  switch (var_i0) {
    case 0: goto var_B2;
    case 1: goto var_B1;
    case 2: goto var_B2;
    case 3: goto var_B0;
    default: goto var_B3;
  }
  var_B3:;
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l0 > 3u);
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l0 != 65535u); /* false */
  goto var_B0;
  var_B2:;
  var_l1 += 1u;
  w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_l0 | 2u) == 2u);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l0 != 2u); /* false */
  var_B1:;
  var_l1 += 2u;
  w2c_prover_claim(instance->w2c_prover_instance, 4u, var_l1 == (var_l0 == 1u ? 2u : 3u) && var_l0 < 3u);
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 5u, (var_l1 == 0u) == (var_l0 >= 3u));
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l1 != 0u || var_l0 != 3u); /* false */
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 != 2u); /* false */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 3u && var_l0 == 0u);
  FUNC_EPILOGUE;
}
