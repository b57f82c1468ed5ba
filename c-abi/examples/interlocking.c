/* A station of one route over one point: a train waits in circuit 0, runs over 1 (the point) and 2, and leaves to 3. */
#include <stdio.h>

#include "atc.h"

int main(void)
{
    static const uint16_t lengths[] = {200, 50, 300, 200}, braking[] = {0, 100, 250};
    static const uint64_t detectors[] = {1u << 1};
    static const atc_element path[] = {{.circuits = 1u << 1, .normal = 1u << 0}, {.circuits = 1u << 2}};
    static const atc_route routes[] = {{.entry = 1u << 0, .approach = 1u << 0, .beyond = 1u << 3,
                                        .path_first = 0, .path_length = 2,
                                        .drive_cycles = 20, .release_cycles = 30, .stay_cycles = 10,
                                        .heading = ATC_HEADING_RIGHT, .speed_code = 2}};
    const atc_interlocking_config plan = {.lengths_m = lengths, .circuit_count = 4,
                                          .detectors = detectors, .point_count = 1, .routes = routes, .route_count = 1,
                                          .elements = path, .element_count = 2, .braking_m = braking, .code_count = 3,
                                          .turn_cycles = 1, .clear_cycles = 2};
    static const uint64_t all = 0xF;
    /* Where the train is in each cycle; the request is made in the fourth one, and the point arrives in the sixth. */
    static const uint64_t occupied[] = {1, 1, 1, 1, 1, 1, 1, 3, 3, 2, 6, 4, 4, 12, 8, 8, 8, 0, 0};
    static atc_interlocking device;
    atc_interlocking_output said;
    atc_status status = atc_interlocking_start(&device, sizeof device, &plan);

    if (status != ATC_STATUS_OK) {
        atc_place where;
        (void)atc_interlocking_check_plan(&plan, &where);
        fprintf(stderr, "plan: %s (kind %u, number %u)\n", atc_status_text(status), (unsigned)where.kind,
                (unsigned)where.first);
        return 1;
    }
    for (size_t cycle = 0; cycle < sizeof occupied / sizeof *occupied; cycle++) {
        const int arrived = cycle >= 5;
        const atc_interlocking_input read = {.occupied = occupied[cycle], .detected_normal = arrived,
                                             .detected_reverse = !arrived, .unblock = cycle == 0 ? all : 0,
                                             .lift = cycle == 0 ? all : 0, .number = 0,
                                             .request = cycle == 3 ? ATC_REQUEST_SET : ATC_REQUEST_NONE};
        status = atc_interlocking_step(&device, &read, &said);
        if (status != ATC_STATUS_OK) {
            fprintf(stderr, "interlocking: %s\n", atc_status_text(status));
            return 1;
        }
        printf("cycle %zu: answer %u, phase %u, proceed %u, drives %u, from 0 to %u at code %u\n", cycle + 1,
               (unsigned)said.answer, said.phases[0], (unsigned)said.proceed, (unsigned)said.drive_normal,
               said.telegrams[0].stop, said.telegrams[0].speed_code);
    }
    return 0;
}
