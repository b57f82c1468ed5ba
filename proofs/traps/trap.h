/* What stands before a trap in C: as wasm2c begins the C of a harness. The trap is a function in
   wasm2c's manner, w2c_h_NAME. */
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

#define FUNC_PROLOGUE
#define FUNC_EPILOGUE
#define UNREACHABLE wasm_rt_trap(WASM_RT_TRAP_UNREACHABLE)

struct w2c_prover;
typedef struct w2c_h { struct w2c_prover* w2c_prover_instance; } w2c_h;
u32 w2c_prover_word(struct w2c_prover*);
void w2c_prover_assume(struct w2c_prover*, u32);
void w2c_prover_claim(struct w2c_prover*, u32, u32);
void w2c_prover_cover(struct w2c_prover*, u32, u32);

void wasm2c_h_instantiate(w2c_h* instance, struct w2c_prover* prover) {
  instance->w2c_prover_instance = prover;
}
