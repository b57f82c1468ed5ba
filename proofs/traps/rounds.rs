//! A loop in a loop, with ways out of both and ways on in the outer one.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn rounds() {
    let (stop, skip) = (word() % 8, word() % 4);
    let (mut sum, mut last) = (0, 0);
    'outer: for row in 0..3 {
        for column in 0..2 {
            if row * 2 + column == stop {
                break 'outer;
            }
            if column == skip && row % 2 == 1 {
                continue 'outer;
            }
            sum += 1;
        }
        last = row + 1;
    }
    claim(0, u32::from(sum <= stop)); // false: the third value is passed over
    claim(1, u32::from(sum + 2 >= stop || stop > 6));
    claim(2, u32::from(sum != 5)); // false
    claim(3, u32::from(last * 2 <= sum || skip < 2));
    claim(4, u32::from(last != 3 || sum > 4)); // false: a row is skipped
    cover(0, u32::from(last == 2 && stop == 5));
}
