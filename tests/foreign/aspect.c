// Aspect acceptance, written from spec/aspect.md alone, without the kernel. It speaks protocol 1 of oracle/README.md.
// Build: gcc -std=c11 -Wall -Wextra -Werror -O1 aspect.c -o aspect; with --fault 1 to 12 it has a fault on purpose.
#include "json.h"

enum { MOST_ASPECTS = 16, MOST_CYCLES = 60000 };

struct one {
    int run, age; // cycles; the age is 0 while the aspect is not lost
    bool accepted, dropped, credit;
};

static struct {
    int aspects;
    int64_t speed[MOST_ASPECTS]; // tenths of km/h
    int64_t t1, t2, t3, t4, t5;  // cycles
    struct one one[MOST_ASPECTS];
    int last; // -1: none
} state;

static void print_speed(int64_t tenths) {
    printf("%lld", (long long)(tenths / 10));
    if (tenths % 10 != 0) printf(".%lld", (long long)(tenths % 10));
}

static bool milliseconds(const struct json *config, const char *name, int64_t otherwise, int64_t *out) {
    const struct json *value = json_field(config, name);
    *out = otherwise;
    return !value || json_whole(value, UINT32_MAX, out);
}

static bool start(const struct json *config) {
    static const char *const fields[] = {"aspects_km_h", "cycle_ms", "operate_ms", "recovery_ms", "mask_ms", "interruption_ms",
                                         "shortened_operate_ms", NULL};
    int64_t cycle, operate, recovery, mask, interruption, shortened;
    const struct json *aspects = json_only(config, fields) ? json_field(config, "aspects_km_h") : NULL;
    if (!aspects || aspects->kind != J_ARRAY || !milliseconds(config, "cycle_ms", 10, &cycle) ||
        !milliseconds(config, "operate_ms", 300, &operate) || !milliseconds(config, "recovery_ms", 400, &recovery) ||
        !milliseconds(config, "mask_ms", 400, &mask) || !milliseconds(config, "interruption_ms", 800, &interruption) ||
        !milliseconds(config, "shortened_operate_ms", 100, &shortened)) {
        json_malformed("the config is not one of aspect acceptance");
        return false;
    }
    memset(&state, 0, sizeof state);
    state.last = -1;
    for (const struct json *item = json_first(aspects); item; item = json_next(item)) {
        int64_t speed;
        struct json size = *item; // of a negative number: its size
        bool negative = item->kind == J_NUMBER && *item->text == '-';
        size.text += negative;
        size.size -= negative;
        if (!json_scaled(&size, 1, INT64_MAX / 100, &speed)) {
            json_malformed("an aspect is a speed in whole tenths of km/h");
            return false;
        }
        if (state.aspects == MOST_ASPECTS || negative || speed > 65535 || (state.aspects > 0 && speed <= state.speed[state.aspects - 1])) {
            json_rejected("TIME-4: the aspects are 1 to 16 speeds that rise");
            return false;
        }
        state.speed[state.aspects++] = speed;
    }
    if (state.aspects == 0 || cycle == 0) {
        json_rejected("TIME-2, TIME-4: there is an aspect, and a cycle has a length");
        return false;
    }
    // TIME-1: what permits by its lapse is rounded up, what is a permission while it lasts is rounded down.
    state.t1 = (operate + cycle - 1) / cycle;
    state.t5 = (shortened + cycle - 1) / cycle;
    state.t2 = recovery / cycle;
    state.t3 = mask / cycle;
    state.t4 = interruption / cycle;
    if (FAULTY(12)) state.t1 = operate / cycle;
    if (state.t1 == 0 || state.t2 == 0 || state.t5 == 0 || state.t5 >= state.t1 || state.t2 + state.t3 > MOST_CYCLES ||
        state.t1 > MOST_CYCLES || state.t4 > MOST_CYCLES) {
        json_rejected("TIME-2: the times are not such as it asks for");
        return false;
    }
    printf("{\"started\":{\"protocol\":1,\"machine\":\"aspect-acceptance\",\"config\":{\"aspects_km_h\":[");
    for (int i = 0; i < state.aspects; i++) {
        if (i > 0) printf(",");
        print_speed(state.speed[i]);
    }
    printf("],\"cycle_ms\":%lld,\"operate_ms\":%lld,\"recovery_ms\":%lld,\"mask_ms\":%lld,\"interruption_ms\":%lld,"
           "\"shortened_operate_ms\":%lld}}}\n",
           (long long)cycle, (long long)operate, (long long)recovery, (long long)mask, (long long)interruption, (long long)shortened);
    return true;
}

// Runs and ages, acceptance, expiry: these three look at one aspect alone.
static void follow(struct one *one, bool detected) {
    int gone = (int)(state.t2 + state.t3);
    one->run = !detected ? 0 : one->run < state.t1 ? one->run + 1 : one->run;
    if (one->age > 0 || (one->accepted && !detected)) one->age++;
    if (FAULTY(1) && detected) one->age = 0; // a detection ends the loss
    if (!detected) {
        if (!(FAULTY(2) && one->age > 0)) one->credit = false; // a credit outlives its run
    } else if (one->age > 0) {
        int gap = one->age - one->run;
        one->credit = (FAULTY(3) ? gap < state.t4 : gap <= state.t4) && gap < gone;
    }
    if (one->run >= state.t1 || (one->credit && one->run >= state.t5 + (FAULTY(4) ? 1 : 0))) {
        one->accepted = true;
        one->age = 0;
        one->dropped = false;
    } else if (one->age >= gone + (FAULTY(5) ? 1 : 0)) {
        one->accepted = one->dropped = false;
        one->age = 0;
        if (FAULTY(6)) one->credit = false; // a credit ends with the aspect
    }
}

static bool step(const struct json *input) {
    static const char *const fields[] = {"detected_km_h", NULL};
    bool detected[MOST_ASPECTS] = {false};
    const struct json *list = json_only(input, fields) ? json_field(input, "detected_km_h") : NULL;
    if (!list || list->kind != J_ARRAY) return false;
    for (const struct json *item = json_first(list); item; item = json_next(item)) {
        int64_t speed;
        int at = 0;
        if (!json_scaled(item, 1, 65535, &speed)) return false;
        while (at < state.aspects && state.speed[at] != speed) at++;
        if (at == state.aspects || detected[at]) return false;
        detected[at] = true;
    }
    for (int i = 0; i < state.aspects; i++) follow(&state.one[i], detected[i]);

    // Drops: ACC-5, a lower aspect is firm; ACC-7, a higher one has evidence.
    bool firm_below = false, dropped[MOST_ASPECTS] = {false};
    for (int i = 0; i < state.aspects; i++) {
        struct one *one = &state.one[i];
        bool masked = one->accepted && one->age >= state.t2;
        bool evidence_above = false;
        for (int j = i + 1; j < state.aspects; j++) {
            if (state.one[j].run == state.t1) evidence_above = true;
            if (FAULTY(7) && state.one[j].accepted && state.one[j].age == 0) evidence_above = true; // T5 is enough
        }
        dropped[i] = masked && (firm_below || (evidence_above && !FAULTY(9)));
        if (one->accepted && one->age < state.t2) firm_below = true;
    }
    int lowest = -1, evidence = -1;
    for (int i = 0; i < state.aspects; i++) {
        struct one *one = &state.one[i];
        one->dropped = one->dropped || dropped[i];
        if (lowest < 0 && one->accepted && !one->dropped) lowest = i;
        if (FAULTY(10) && one->accepted && !one->dropped) lowest = i; // the highest wins
        if (one->run == state.t1) evidence = i;
    }
    // ACC-9: no rise without evidence, of this aspect or a higher one.
    int shown = lowest >= 0 && (lowest <= state.last || evidence >= lowest || FAULTY(11)) ? lowest : -1;
    if (shown >= 0 || FAULTY(8)) state.last = shown; // fault 8: the last one is forgotten
    printf("{\"output\":{\"display_km_h\":");
    if (shown < 0) printf("null");
    else print_speed(state.speed[shown]);
    printf("}}\n");
    return true;
}

int main(int count, char **arguments) {
    static const struct machine machine = {"aspect-acceptance", start, step};
    return json_serve(&machine, count, arguments);
}
