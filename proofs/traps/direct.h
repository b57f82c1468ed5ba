/* What stands before a trap that is about CBMC alone: no driver, no rewriting. */
#ifdef REACH
#define CLAIM(n, holds) __CPROVER_assert(0, "claim " #n)
#elif defined(BOTH)
#define CLAIM(n, holds) do { __CPROVER_assert(holds, "claim " #n); __CPROVER_assert(0, "reach " #n); } while (0)
#else
#define CLAIM(n, holds) __CPROVER_assert(holds, "claim " #n)
#endif
#if defined(REACH) || defined(BOTH)
#define COVER(n, reached) __CPROVER_assert(!(reached), "cover " #n)
#else
#define COVER(n, reached) __CPROVER_assert(1, "cover " #n)
#endif
unsigned nondet_u32(void);

