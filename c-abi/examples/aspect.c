/* A train at 50 km/h hears 45 and 90 km/h for a second and then nothing: what is displayed, and the brake. */
#include <stdio.h>

#include "atc.h"

static int failed(const char *what, atc_status status)
{
    if (status != ATC_STATUS_OK)
        fprintf(stderr, "%s: %s\n", what, atc_status_text(status));
    return status != ATC_STATUS_OK;
}

int main(void)
{
    static const char *const brakes[] = {"release", "service", "emergency"};
    const atc_aspect_config line = {.cycle_ms = 10, .operate_ms = 300, .recovery_ms = 400, .mask_ms = 400,
                                    .interruption_ms = 800, .shortened_operate_ms = 100,
                                    .aspect_count = 4, .speeds = {250, 450, 650, 900}};
    const atc_supervision_config train = {.maximum = 4000, .margin = 0};
    atc_aspect aspect;
    atc_supervision supervision;
    atc_aspect_output shown = {0};
    atc_supervision_output command = {0};

    if (atc_version() != ATC_VERSION) {
        fputs("the library is of another version than its header\n", stderr);
        return 1;
    }
    if (failed("aspect", atc_aspect_start(&aspect, sizeof aspect, &line)) ||
        failed("supervision", atc_supervision_start(&supervision, sizeof supervision, &train)))
        return 1;
    for (int cycle = 1; cycle <= 200; cycle++) {
        /* Bit i for the aspect of rank i: 45 km/h is rank 1, 90 km/h is rank 3. */
        const atc_aspect_input heard = {.detected = cycle <= 100 ? 1u << 1 | 1u << 3 : 0};
        const atc_aspect_output before = shown;
        const uint32_t brake = command.brake;

        if (failed("aspect", atc_aspect_step(&aspect, &heard, &shown)))
            return 1;
        const atc_supervision_input speeds = {.measured = 500, .has_measured = 1,
                                              .permitted = shown.speed, .has_permitted = shown.displayed};
        if (failed("supervision", atc_supervision_step(&supervision, &speeds, &command)))
            return 1;
        if (cycle > 1 && shown.speed == before.speed && command.brake == brake)
            continue;
        if (shown.displayed)
            printf("cycle %d: %u.%u km/h, %s\n", cycle, shown.speed / 10u, shown.speed % 10u, brakes[command.brake]);
        else
            printf("cycle %d: no display, %s\n", cycle, brakes[command.brake]);
    }
    return 0;
}
