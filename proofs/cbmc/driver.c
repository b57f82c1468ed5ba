/* The CBMC driver of one harness: what the generated C (wasm2c, HARNESS_C) asks for.

   -DHARNESS=name      the exported function to run
   -DCASE=n -DCASES=m  the case to prove, of a harness that is split into cases
   -DREACH             replaces every claim by false: each one that can be reached must then FAIL
   -DBOTH              asks both in one run: beside each claim, `reach` of its number is such a false one
   -DMUTANTS           the code has mutants in it, and `mutants.h` lists those to ask for: MUTANTS(M) is M(number) for each. One of them
                       is selected, and `mutant` of its number holds if no claim fails then. 0 is none of them
   -DONLY=number       with -DMUTANTS: this one is selected, which CBMC can count on
   -DCONTROL           with -DMUTANTS: everything else that a proof asks, too
   -DTRAPS             with -DMUTANTS: a panic is as good as a claim that fails
   -DNATIVE            no CBMC: a program that prints what happens. Each line of its input is a run: the number of a mutant (0: none),
                       the case, and the arbitrary values in order

   MEMORY is bytes of linear memory, a multiple of 4: the stack and the data; DATA are the words in it at the start.
   `harness.h` says them.

   Claims and cover points have numbers; each number is an assertion of its own, so that it has a verdict of its own.
   A trap (panic, overflow check, index out of bounds, division by zero, unreachable) is an assertion too.

   Linear memory is an array of 32-bit words with accesses of our own, because wasm2c's go through
   __builtin_memcpy, which CBMC does not see into; an access that is out of bounds is an assertion. */
#include "harness.h"

#ifdef NATIVE
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
static jmp_buf end_of_run;
/* Everything that happens is a line. An assumption that does not hold ends the run. */
static void happens(const char *what, u32 holds) { printf("%s %u\n", what, holds != 0); }
static void end_run(void) { longjmp(end_of_run, 1); }
#define __CPROVER_assert(holds, text) ((holds) ? (void)0 : happens(text, 0))
#define __CPROVER_assume(holds) ((holds) ? (void)0 : end_run())
#endif

#ifdef MUTANTS
#include "mutants.h"
static u32 chosen;
#define REJECTED(n) __CPROVER_assert(holds || chosen != n, "mutant " #n);
static void claimed(u32 holds) { MUTANTS(REJECTED) }
#endif

#if defined(MUTANTS) && !defined(NATIVE) && !defined(CONTROL)
/* Of a mutant only what rejects it is asked. */
#define CHECK(holds, text) ((void)0)
#else
#define CHECK(holds, text) __CPROVER_assert(holds, text)
#endif

/* The data are in it from the start. */
static u32 words[MEMORY / 4] = DATA;

/* The word of an access that lies in one: n bytes, at a multiple of n. */
#define AT(a, n) \
  (CHECK((a) + (n) <= MEMORY, "trap: out of bounds (memory, or the stack has run out)"), \
   __CPROVER_assume((a) + (n) <= MEMORY), \
   words[(a) / 4])
static inline u32 i32_load8_u(wasm_rt_memory_t *m, u64 a) { return (u8)(AT(a, 1) >> (8 * (a & 3))); }
static inline u32 i32_load8_s(wasm_rt_memory_t *m, u64 a) { return (u32)(s32)(s8)i32_load8_u(m, a); }
/* WebAssembly allows any address. Where the address is a constant, as most are, the choice costs nothing. */
static inline u32 i32_load16_u(wasm_rt_memory_t *m, u64 a) {
  if ((a & 1) == 0) return (u16)(AT(a, 2) >> (8 * (a & 2)));
  return i32_load8_u(m, a) | i32_load8_u(m, a + 1) << 8;
}
static inline u32 i32_load16_s(wasm_rt_memory_t *m, u64 a) { return (u32)(s32)(s16)i32_load16_u(m, a); }
static inline u32 i32_load(wasm_rt_memory_t *m, u64 a) {
  if ((a & 3) == 0) return AT(a, 4);
  return i32_load16_u(m, a) | i32_load16_u(m, a + 2) << 16;
}
static inline u64 i64_load32_u(wasm_rt_memory_t *m, u64 a) { return i32_load(m, a); }
static inline u64 i64_load32_s(wasm_rt_memory_t *m, u64 a) { return (u64)(s64)(s32)i32_load(m, a); }
static inline u64 i64_load16_u(wasm_rt_memory_t *m, u64 a) { return i32_load16_u(m, a); }
static inline u64 i64_load16_s(wasm_rt_memory_t *m, u64 a) { return (u64)(s64)(s16)i32_load16_u(m, a); }
static inline u64 i64_load8_u(wasm_rt_memory_t *m, u64 a) { return i32_load8_u(m, a); }
static inline u64 i64_load8_s(wasm_rt_memory_t *m, u64 a) { return (u64)(s64)(s8)i32_load8_u(m, a); }
static inline u64 i64_load(wasm_rt_memory_t *m, u64 a) { return (u64)i32_load(m, a) | (u64)i32_load(m, a + 4) << 32; }
static inline void i32_store8(wasm_rt_memory_t *m, u64 a, u32 v) {
  u32 s = 8 * (a & 3), w = AT(a, 1);
  words[a / 4] = (w & ~(0xffu << s)) | (v & 0xff) << s;
}
static inline void i32_store16(wasm_rt_memory_t *m, u64 a, u32 v) {
  if ((a & 1) == 0) {
    u32 s = 8 * (a & 2), w = AT(a, 2);
    words[a / 4] = (w & ~(0xffffu << s)) | (v & 0xffff) << s;
  } else {
    i32_store8(m, a, v);
    i32_store8(m, a + 1, v >> 8);
  }
}
static inline void i32_store(wasm_rt_memory_t *m, u64 a, u32 v) {
  if ((a & 3) == 0) {
    AT(a, 4);
    words[a / 4] = v;
  } else {
    i32_store16(m, a, v);
    i32_store16(m, a + 2, v >> 16);
  }
}
static inline void i64_store8(wasm_rt_memory_t *m, u64 a, u64 v) { i32_store8(m, a, (u32)v); }
static inline void i64_store16(wasm_rt_memory_t *m, u64 a, u64 v) { i32_store16(m, a, (u32)v); }
static inline void i64_store32(wasm_rt_memory_t *m, u64 a, u64 v) { i32_store(m, a, (u32)v); }
static inline void i64_store(wasm_rt_memory_t *m, u64 a, u64 v) {
  i32_store(m, a, (u32)v);
  i32_store(m, a + 4, (u32)(v >> 32));
}

/* The runner has taken the data segments out of the C. */
#define LOAD_DATA(m, o, i, s) CHECK(0, "trap: other data")

#ifndef HARNESS_C
#define HARNESS_C "harness.c"
#endif
#include HARNESS_C

void wasm_rt_trap(wasm_rt_trap_t code) {
  CHECK(code != WASM_RT_TRAP_UNREACHABLE, "trap: panic");
  CHECK(code == WASM_RT_TRAP_UNREACHABLE, "trap: other");
#if defined(MUTANTS) && defined(TRAPS)
  claimed(code != WASM_RT_TRAP_UNREACHABLE);
#endif
  __CPROVER_assume(0);
  while (1) {}
}

bool wasm_rt_is_initialized(void) { return true; }

void wasm_rt_allocate_memory(wasm_rt_memory_t *m, uint64_t pages, uint64_t max, bool is64) {
  m->data = 0;
  m->pages = pages;
  m->max_pages = max;
  m->size = MEMORY;
  m->is64 = is64;
}

#ifdef NATIVE
/* Some harnesses have a table of functions. The provers' runs never fill it: a call through it is a trap there. */
void wasm_rt_allocate_funcref_table(wasm_rt_funcref_table_t *t, uint32_t elements, uint32_t max) {
  t->data = calloc(elements, sizeof *t->data);
  t->size = t->data ? elements : 0;
  t->max_size = max;
}
void wasm_rt_free_funcref_table(wasm_rt_funcref_table_t *t) { free(t->data); }
#endif

struct w2c_prover { u32 unused; };

#ifdef NATIVE
static char *tape;
/* 0 when they run out. */
static u32 nondet_u32(void) { return (u32)strtoul(tape, &tape, 10); }
#else
u32 nondet_u32(void);
#endif

/* The arbitrary values in a trace: what is assigned to this, with a number from 1 above them. What no assertion depends on is not in a
   trace, so that their order alone does not say which is which. */
static u32 drawn;
static u32 draws;

u32 w2c_prover_word(struct w2c_prover *p) {
  draws += 1;
  drawn = (nondet_u32() & 0xffff) | draws << 16;
  return drawn & 0xffff;
}

/* The case of a harness that is proven case by case: -DCASE=number of -DCASES. */
#ifdef NATIVE
static u32 picked;
#endif

u32 w2c_prover_choose(struct w2c_prover *p, u32 cases) {
#ifdef NATIVE
  return picked;
#else
  CHECK(cases == CASES, "trap: number of cases");
  return CASE;
#endif
}

#ifdef MUTANTS
/* The others are constant: what they change is not there for the prover. */
#define SELECTED(n) case n: return chosen == n;
u32 w2c_prover_selected(struct w2c_prover *p, u32 number) {
  switch (number) {
    MUTANTS(SELECTED)
    default: return 0;
  }
}
#endif

void w2c_prover_assume(struct w2c_prover *p, u32 holds) { __CPROVER_assume(holds != 0); }

#if defined(NATIVE)
#define CLAIM(n) case n: happens("claim " #n, holds); break;
#elif defined(MUTANTS)
#define CLAIM(n) case n: claimed(holds != 0); break;
#elif defined(REACH)
#define CLAIM(n) case n: __CPROVER_assert(0, "claim " #n); break;
#elif defined(BOTH)
#define CLAIM(n) case n: __CPROVER_assert(holds != 0, "claim " #n); __CPROVER_assert(0, "reach " #n); break;
#else
#define CLAIM(n) case n: __CPROVER_assert(holds != 0, "claim " #n); break;
#endif
#if defined(REACH) || defined(BOTH)
#define COVERED(reached) ((reached) == 0)
#else
#define COVERED(reached) 1
#endif
#if defined(NATIVE)
#define COVER(n) case n: happens("cover " #n, reached); break;
#elif defined(MUTANTS)
#define COVER(n) case n: break;
#else
#define COVER(n) case n: __CPROVER_assert(COVERED(reached), "cover " #n); break;
#endif

void w2c_prover_claim(struct w2c_prover *p, u32 number, u32 holds) {
  switch (number) {
    CLAIM(0) CLAIM(1) CLAIM(2) CLAIM(3) CLAIM(4) CLAIM(5) CLAIM(6) CLAIM(7)
    default: CHECK(0, "trap: number of a claim");
  }
}

void w2c_prover_cover(struct w2c_prover *p, u32 number, u32 reached) {
  switch (number) {
    COVER(0) COVER(1) COVER(2) COVER(3) COVER(4) COVER(5) COVER(6) COVER(7)
    default: CHECK(0, "trap: number of a cover point");
  }
}

#define JOIN2(a, b) a##b
#define JOIN(a, b) JOIN2(a, b)
static struct w2c_prover prover;
static w2c_h instance;

#ifdef NATIVE
void wasm_rt_free_memory(wasm_rt_memory_t *m) {}

static const u32 data[MEMORY / 4] = DATA;

int main(void) {
  static char line[1 << 20];
  while (fgets(line, sizeof line, stdin)) {
    u32 selected = (u32)strtoul(line, &tape, 10);
    picked = nondet_u32();
#ifdef MUTANTS
    chosen = selected;
#endif
    printf("run %u\n", selected);
    memcpy(words, data, sizeof words);
    if (setjmp(end_of_run)) {
      puts("assumed away");
    } else {
      wasm2c_h_instantiate(&instance, &prover);
      JOIN(w2c_h_, HARNESS)(&instance);
      puts("end");
    }
  }
  return 0;
}
#else
#define OR_CHOSEN(n) || chosen == n
int main(void) {
#ifdef ONLY
  chosen = ONLY;
#elif defined(MUTANTS)
  chosen = nondet_u32();
  __CPROVER_assume(0 MUTANTS(OR_CHOSEN));
#endif
  wasm2c_h_instantiate(&instance, &prover);
  JOIN(w2c_h_, HARNESS)(&instance);
  return 0;
}
#endif
