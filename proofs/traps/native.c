/* Runs a trap as a program: for each run the values are given or drawn, and a claim that fails once has failed.

   The driver (or the trap itself, where it has none) is the very text that CBMC reads: what it asks of CBMC is a
   function here. Arguments: runs with given values, such as 7,65535. After them come 65536 drawn ones, in which the
   first value takes every value that there is.
   Output: one line for each assertion that was come by, `0` (held) or `1` (failed once) and its description. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static jmp_buf over;
static struct { const char *what; int failed; } seen[64];
static unsigned known;
static unsigned given[64], count, next, state;

static void judge(int holds, const char *what) {
  unsigned k = 0;
  while (k < known && strcmp(seen[k].what, what) != 0) k++;
  if (k == 64) exit(3);
  if (k == known) seen[known++].what = what;
  if (!holds) seen[k].failed = 1;
}
static void demand(int holds) { if (!holds) longjmp(over, 1); }
#define __CPROVER_assert(holds, what) judge((holds) != 0, what)
#define __CPROVER_assume(holds) demand((holds) != 0)

/* Small values, bits and limits as often as others. */
static unsigned draw(void) {
  state = state * 1664525u + 1013904223u;
  unsigned value = state >> 12, kind = state >> 29;
  if (kind == 0) return value & 7;
  if (kind == 1) return value & 255;
  if (kind == 2) return 1u << (value & 15);
  if (kind == 3) return 65535u - (value & 1);
  return value & 65535;
}
unsigned nondet_u32(void) { return next < count ? given[next++] : draw(); }

#define main trap_main
#include "driver.c"
#undef main

static void once(void) {
  next = 0;
#ifdef MEMORY
  static const u32 at_start[MEMORY / 4] = DATA;
  memcpy(words, at_start, sizeof words);
#endif
  if (setjmp(over) == 0) trap_main();
}

#ifdef MEMORY
void wasm_rt_free_memory(wasm_rt_memory_t *m) { m->data = 0; }
#endif

int main(int arguments, char **argument) {
  for (int k = 1; k < arguments; k++) {
    char *rest = argument[k];
    for (count = 0; *rest && count < 64; rest += *rest == ',') given[count++] = (unsigned)strtoul(rest, &rest, 10);
    once();
  }
  count = 1;
  for (given[0] = 0; given[0] < 65536; given[0]++) once();
  for (unsigned k = 0; k < known; k++) printf("%d %s\n", seen[k].failed, seen[k].what);
  return 0;
}
