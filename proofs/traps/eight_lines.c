/* The eight lines: CBMC 6.6.0 says of the claim that it holds. With any even value it fails. */
int main(void) {
  unsigned round = 0, value = nondet_u32();
back:
  if (round == 1) goto done;
  round++;
  if (value & 1) goto back;
  CLAIM(0, 0);
done:
  return 0;
}
