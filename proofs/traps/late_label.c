/* A jump back to a place that was not reached before: no loop, though it looks like one. */
int main(void) {
  unsigned value = nondet_u32() & 7, path = 1;
  goto work;
leave:
  CLAIM(0, path == 2 || path == 4);
  CLAIM(1, path != 4); /* false */
  COVER(0, path == 2);
  return 0;
work:
  path = 2;
  if (value == 3) goto leave;
  path = 4;
  CLAIM(2, value != 3);
  goto leave;
}
