/* The ground sends main telegrams bit by bit; the train finds them, and its permitted speed follows. */
#include <stdio.h>

#include "atc.h"

/* The result of a call, which is never to be passed over. */
static int failed(const char *what, atc_status status)
{
    if (status != ATC_STATUS_OK)
        fprintf(stderr, "%s: %s\n", what, atc_status_text(status));
    return status != ATC_STATUS_OK;
}

int main(void)
{
    const atc_permitted_config line = {
        .cycle_ms = 10, .fresh_ms = 2200, .life_ms = 5000, .fixed_life_ms = 10000, .memory_ms = 2000,
        .speed_count = 8, .speeds = {0, 150, 250, 450, 550, 650, 750, 900}, .lowest_rank = 2,
        .brake_mm_s2 = 800, .worst_gradient_permille = -35, .margin_m = 10, .window = 3, .run = 1};
    atc_permitted permitted;
    atc_deframer deframer;

    if (failed("permitted", atc_permitted_start(&permitted, sizeof permitted, &line)) ||
        failed("deframer", atc_deframer_start(&deframer, sizeof deframer)))
        return 1;
    for (unsigned number = 1; number <= 4; number++) {
        const atc_telegram sent = {.kind = ATC_TELEGRAM_MAIN,
                                   .main_data = {.section = 7, .counter = (uint8_t)number, .route_open = 1,
                                                 .beyond_exit_m = 400, .speed_rank = 4}};
        atc_frame frame;
        atc_permitted_output may = {0};

        if (failed("encode", atc_telegram_encode(&sent, &frame)))
            return 1;
        /* One bit a cycle; of the third frame one bit is wrong. */
        if (number == 3)
            frame.bits[40] ^= 1;
        for (unsigned bit = 0; bit < sizeof frame.bits; bit++) {
            const atc_deframer_input heard = {.reception = frame.bits[bit]};
            atc_telegram found;

            if (failed("deframer", atc_deframer_step(&deframer, &heard, &found)))
                return 1;
            const atc_permitted_input input = {.analog = 450, .has_analog = 1, .moved_mm = 50,
                                               .has_main = found.kind == ATC_TELEGRAM_MAIN,
                                               .main_data = found.main_data};
            if (failed("permitted", atc_permitted_step(&permitted, &input, &may)))
                return 1;
        }
        printf("telegram %u: %u.%u km/h, basis %u\n", number, may.speed / 10u, may.speed % 10u, (unsigned)may.basis);
    }
    return 0;
}
