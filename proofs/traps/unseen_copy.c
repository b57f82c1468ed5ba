/* wasm2c's own loads and stores go through __builtin_memcpy, which CBMC does not look into: what is stored is lost. */
int main(void) {
  unsigned from = nondet_u32(), to = 0;
  __builtin_memcpy(&to, &from, sizeof to);
  CLAIM(0, to == 0); /* false, and cbmc 6.6.0 would prove it */
  COVER(0, from == 1);
  return 0;
}
