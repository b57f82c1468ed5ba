//! Ways out of four blocks within each other, taken for some values, with something said at the end of each.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn exits() {
    let value = word() % 64;
    let mut path;
    let left = 'one: {
        'two: {
            'three: {
                'four: {
                    if value % 2 == 1 {
                        path = 4;
                        break 'four;
                    }
                    if value % 4 == 2 {
                        path = 2;
                        break 'two;
                    }
                    claim(0, u32::from(value % 4 == 0));
                    if value > 40 {
                        break 'one value;
                    }
                    path = word() % 2;
                }
                claim(1, u32::from(path == 4 || value <= 40));
                if value == 33 {
                    break 'one 99;
                }
                if path == 1 {
                    break 'two;
                }
                if path == 0 && value % 8 == 0 {
                    break 'three;
                }
                claim(2, u32::from(path == 4 && value != 33 || path == 0 && value % 8 == 4));
            }
            path += 1;
            claim(3, u32::from(path != 5 || value != 35)); // false
        }
        claim(4, u32::from((path == 2) == (value % 4 == 2)));
        claim(5, u32::from(path != 2 || value < 62)); // false
        word() % 8
    };
    claim(6, u32::from(left < 8 || left == 99 || left > 40 && left % 4 == 0));
    claim(7, u32::from(left != 60)); // false
    cover(0, u32::from(left == 99));
}
