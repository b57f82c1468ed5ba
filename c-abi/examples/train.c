/* The whole on-board device: a train at 50 km/h hears the codes of 45 km/h for a second, and then nothing. */
#include <stdio.h>

#include "atc.h"

int main(void)
{
    static const char *const brakes[] = {"release", "service", "emergency"};
    static const atc_train_config config = {
        .permitted = {.cycle_ms = 10, .fresh_ms = 2200, .life_ms = 5000, .fixed_life_ms = 10000, .memory_ms = 2000,
                      .speed_count = 3, .speeds = {0, 450, 900}, .brake_mm_s2 = 800, .margin_m = 10, .lowest_rank = 1,
                      .worst_gradient_permille = -35, .window = 3, .run = 1},
        .operate_ms = 300, .recovery_ms = 400, .mask_ms = 400, .interruption_ms = 800, .shortened_operate_ms = 100,
        .code_tolerance_millihertz = 500, .code_count = 3,
        .codes = {{22000, 31500, 0}, {26000, 36000, 450}, {29000, 39000, 900}},
        .supervision = {.maximum = 4000, .margin = 0}};
    static atc_train train;
    atc_train_output cab = {.brake = ATC_BRAKE_EMERGENCY};
    atc_status status = atc_train_start(&train, sizeof train, &config);

    for (int cycle = 1; status == ATC_STATUS_OK && cycle <= 200; cycle++) {
        /* A tenth of a hertz off. */
        const atc_train_input heard = {.main_code_millihertz = 26100, .has_main_code = cycle <= 100,
                                       .sub_code_millihertz = 35900, .has_sub_code = cycle <= 100,
                                       .speed = 500, .has_speed = 1, .facing = ATC_HEADING_RIGHT,
                                       .line = cycle == 1 ? ATC_LINE_ANALOG : ATC_LINE_UNCHANGED};
        const atc_train_output before = cab;
        status = atc_train_step(&train, &heard, &cab);
        if (cycle > 1 && cab.display == before.display && cab.brake == before.brake)
            continue;
        if (cab.has_permitted)
            printf("cycle %d: %u.%u km/h permitted, %s\n", cycle, cab.permitted / 10u, cab.permitted % 10u,
                   brakes[cab.brake]);
        else
            printf("cycle %d: nothing permitted, %s\n", cycle, brakes[cab.brake]);
    }
    if (status != ATC_STATUS_OK) {
        fprintf(stderr, "train: %s\n", atc_status_text(status));
        return 1;
    }
    return 0;
}
