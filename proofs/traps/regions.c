/* Regions within regions, in a function that is called twice: what one leaves in a variable is read behind it, a first value is
   there again for the second call, a parameter is assigned, and many jump to a panic. */
u32 w2c_h_regions_0(w2c_h* instance, u32 var_p0, u32 var_p1) {
  u32 var_l0 = 0, var_l1 = 0, 
      var_l2 = 5;
  FUNC_PROLOGUE;
  u32 var_i0, var_i1;
  var_L4: 
    var_i0 = var_p0 & 1u;
    if (var_i0) {goto var_B1;}
    var_i1 = var_p1 == 9u;
    if (var_i1) {goto var_B9;}
    var_l0 += 1u;
    var_i0 = var_p0 & 2u;
    if (var_i0) {goto var_B2;}
    var_l0 += 2u;
    var_i0 = var_p0 & 4u;
    if (var_i0) {goto var_B1;}
    var_l2 += 1u;
    var_B2:;
    var_l1 += var_l0;
    var_B1:;
    var_i0 = var_p1 == 9u;
    if (var_i0) {goto var_B9;}
    var_p0 >>= 3u;
    var_i0 = var_p0;
    if (var_i0) {goto var_L4;}
  var_i0 = var_p1 == 9u;
  if (var_i0) {goto var_B9;}
  var_i0 = var_l0 + 16u * var_l1 + 256u * var_l2;
  goto var_Bfunc;
  var_B9:;
  var_i0 = var_p1;
  UNREACHABLE;
  var_Bfunc:;
  FUNC_EPILOGUE;
  return var_i0;
}

void w2c_h_regions(w2c_h* instance) {
  u32 var_l0 = 0, var_l1 = 0, var_l2 = 0, var_l3 = 0;
  FUNC_PROLOGUE;
  u32 var_i0;
  var_l0 = w2c_prover_word(instance->w2c_prover_instance) & 63u;
  var_l3 = w2c_prover_word(instance->w2c_prover_instance);
  w2c_prover_assume(instance->w2c_prover_instance, var_l3 != 9u);
  var_l1 = w2c_h_regions_0(instance, var_l0, var_l3);
  var_i0 = var_l0 & 1u;
  if (var_i0) {goto var_B0;}
  var_l2 = w2c_h_regions_0(instance, var_l0, 10u);
  w2c_prover_claim(instance->w2c_prover_instance, 0u, var_l1 == var_l2);
  w2c_prover_claim(instance->w2c_prover_instance, 1u, var_l2 != 1587u); /* false: 0 */
  var_i0 = var_l0 & 8u;
  if (var_i0) {goto var_B0;}
  w2c_prover_claim(instance->w2c_prover_instance, 2u, (var_l1 & 15u) >= 1u);
  w2c_prover_claim(instance->w2c_prover_instance, 3u, var_l1 != 1330u); /* false: 18, in two rounds */
  var_B0:;
  w2c_prover_claim(instance->w2c_prover_instance, 4u, (var_l0 & 63u) == var_l0 && (var_l1 >> 8) >= 5u && (var_l1 >> 8) <= 6u);
  w2c_prover_claim(instance->w2c_prover_instance, 5u, var_l1 != 1280u); /* false: 9 goes past all of both rounds */
  w2c_prover_claim(instance->w2c_prover_instance, 6u, var_l2 == 0u || var_l2 == var_l1);
  w2c_prover_claim(instance->w2c_prover_instance, 7u, var_l1 != 1652u || var_l3 != 65535u); /* false */
  w2c_prover_cover(instance->w2c_prover_instance, 0u, var_l1 == 1652u);
  FUNC_EPILOGUE;
}
