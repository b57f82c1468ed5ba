/* A harness as wasm2c writes them, by hand, since the compiler cannot be made to: a loop with a conditional jump back in its middle, and
   a way out over what follows that jump, which the second round takes for certain. `proofs/runner/src/loops.rs` says what
   CBMC makes of it as it stands here. */
#include <stdint.h>
#include "wasm-rt.h"

typedef uint8_t u8;
typedef int8_t s8;
typedef uint16_t u16;
typedef int16_t s16;
typedef uint32_t u32;
typedef int32_t s32;
typedef uint64_t u64;
typedef int64_t s64;

struct w2c_prover;
typedef struct w2c_h { struct w2c_prover *w2c_prover_instance; } w2c_h;
u32 w2c_prover_word(struct w2c_prover *);
void w2c_prover_claim(struct w2c_prover *, u32, u32);
void w2c_prover_cover(struct w2c_prover *, u32, u32);

void w2c_h_loops(w2c_h *instance) {
  u32 var_l0 = 0, var_l1 = 0, var_i0, var_i1;
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
}

void wasm2c_h_instantiate(w2c_h *instance, struct w2c_prover *prover) {
  instance->w2c_prover_instance = prover;
}
