/* An array with an index that is no constant, behind a claim that fails: the form in which external
   solvers were seen to differ. */
int main(void) {
  unsigned cells[2] = {0, 0}, index = nondet_u32();
  if (index < 1) {
    CLAIM(0, index > 5); /* false */
    CLAIM(1, cells[index] == index);
    CLAIM(2, cells[index + 1] == 0);
    COVER(0, index == 0);
  }
  CLAIM(3, index < 7); /* false */
  return 0;
}
