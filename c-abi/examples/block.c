/* One train runs through a block of three sections, after staff have verified that nobody is in it. */
#include <stdio.h>

#include "atc.h"

int main(void)
{
    /* One logic cycle each: the checks at the ends, the section that hears the head, and a reset at the beginning. */
    static const struct {
        uint8_t check_in, check_out, reset;
        uint16_t present;
    } cycles[] = {
        {0, 0, 0, 0},      {0, 0, 1, 0},      {1, 0, 0, 0},      {1, 0, 0, 1u << 0}, {0, 0, 0, 1u << 0},
        {0, 0, 0, 1u << 1}, {0, 0, 0, 1u << 2}, {0, 1, 0, 1u << 2}, {0, 1, 0, 0},      {0, 0, 0, 0},
    };
    const atc_block_config config = {.cycle_ms = 10, .pass_ms = 10000,
                                     .sections = 3, .max_trains = 3, .tail_hold_sections = 1};
    atc_block block;
    atc_block_output said;
    atc_status status = atc_block_start(&block, sizeof block, &config);

    for (size_t cycle = 0; status == ATC_STATUS_OK && cycle < sizeof cycles / sizeof *cycles; cycle++) {
        const atc_block_input read = {.check_in = cycles[cycle].check_in, .check_out = cycles[cycle].check_out,
                                      .present = cycles[cycle].present, .has_reset = cycles[cycle].reset,
                                      .reset = 0, .ahead_hold_sections = 0, .ahead_entered = 1};
        status = atc_block_step(&block, &read, &said);
        printf("cycle %zu: occupied", cycle + 1);
        for (unsigned section = 0; section < config.sections; section++)
            if (said.occupied >> section & 1u)
                printf(" %u", section);
        printf("; trains %u, behind %u%s\n", said.count, said.behind_hold_sections,
               said.status == ATC_BLOCK_COUNTING ? "" : ", not counting");
    }
    if (status != ATC_STATUS_OK) {
        fprintf(stderr, "block: %s\n", atc_status_text(status));
        return 1;
    }
    return 0;
}
