/* A row of 100 circuits with 98 routes of one circuit each: sets of a large station, number by number. */
#include <stdio.h>

#include "atc.h"

enum { CIRCUITS = 100, ROUTES = CIRCUITS - 2, FIRST = 80 };

static atc_set256 with(atc_set256 set, unsigned number)
{
    set.words[number / 64] |= UINT64_C(1) << (number % 64);
    return set;
}

static unsigned has(const atc_set256 *set, unsigned number)
{
    return (unsigned)(set->words[number / 64] >> (number % 64) & 1);
}

int main(void)
{
    static uint16_t lengths[CIRCUITS];
    static const uint16_t braking[] = {0, 100};
    static atc_large_element path[ROUTES];
    static atc_large_route routes[ROUTES];
    /* Not on the stack: it has 0.9 MB. */
    static atc_large_interlocking device;
    static atc_large_interlocking_output said;
    static const atc_set256 none;
    const atc_large_interlocking_config plan = {.lengths_m = lengths, .circuit_count = CIRCUITS,
                                                .routes = routes, .route_count = ROUTES, .elements = path,
                                                .element_count = ROUTES, .braking_m = braking, .code_count = 2,
                                                .turn_cycles = 1, .clear_cycles = 2};
    atc_set256 all = none;
    atc_status status;
    for (unsigned number = 0; number < CIRCUITS; number++) {
        lengths[number] = 200;
        all = with(all, number);
    }
    for (unsigned number = 0; number < ROUTES; number++) {
        path[number].circuits = with(none, number + 1);
        routes[number] = (atc_large_route){.entry = with(none, number), .approach = with(none, number),
                                           .beyond = with(none, number + 2), .path_first = (uint16_t)number,
                                           .path_length = 1, .drive_cycles = 20, .release_cycles = 30,
                                           .stay_cycles = 10, .heading = ATC_HEADING_RIGHT, .speed_code = 1};
    }
    status = atc_large_interlocking_start(&device, sizeof device, &plan);
    /* A train waits in circuit 80; the route from there is requested in the fourth cycle. */
    for (unsigned cycle = 1; status == ATC_STATUS_OK && cycle <= 8; cycle++) {
        const atc_large_interlocking_input read = {.occupied = with(cycle > 6 ? with(none, FIRST + 1) : none, FIRST),
                                                   .unblock = cycle == 1 ? all : none,
                                                   .lift = cycle == 1 ? all : none, .number = FIRST,
                                                   .request = cycle == 4 ? ATC_REQUEST_SET : ATC_REQUEST_NONE};
        status = atc_large_interlocking_step(&device, &read, &said);
        printf("cycle %u: answer %u, phase %u, proceed %u, from %d to %u at code %u\n", cycle, (unsigned)said.answer,
               said.phases[FIRST], has(&said.proceed, FIRST), FIRST, said.telegrams[FIRST].stop,
               said.telegrams[FIRST].speed_code);
    }
    if (status != ATC_STATUS_OK) {
        fprintf(stderr, "large station: %s\n", atc_status_text(status));
        return 1;
    }
    return 0;
}
