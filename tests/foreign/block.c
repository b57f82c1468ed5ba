// Block counting, written from spec/block.md alone, without the kernel. It speaks protocol 1 of oracle/README.md.
// Build: gcc -std=c11 -Wall -Wextra -Werror -O1 block.c -o block; with --fault 1 to 14 it has a fault on purpose.
#include "json.h"

enum { MOST_SECTIONS = 16, MOST_CYCLES = 60000 };
enum standing { UNVERIFIED, COUNTING, STAYS_ON, AT_MAXIMUM, AT_ZERO };

static struct {
    int sections, most, hold; // hold: sections held behind a head
    int64_t pass;             // cycles
    enum standing standing;
    int count, pending;
    int64_t on;               // for how many cycles the check-in has been on, at most one more than the pass time
    bool out;                 // the level of the check-out in the cycle before
} state;

static bool start(const struct json *config) {
    static const char *const fields[] = {"sections", "max_trains", "tail_hold_sections", "cycle_ms", "pass_ms", NULL};
    int64_t sections, most, hold, cycle = 10, pass = 10000;
    bool fits = json_only(config, fields) && json_whole(json_field(config, "sections"), UINT32_MAX, &sections) &&
                json_whole(json_field(config, "max_trains"), UINT32_MAX, &most) &&
                json_whole(json_field(config, "tail_hold_sections"), UINT32_MAX, &hold);
    if (fits && json_field(config, "cycle_ms")) fits = json_whole(json_field(config, "cycle_ms"), UINT32_MAX, &cycle);
    if (fits && json_field(config, "pass_ms")) fits = json_whole(json_field(config, "pass_ms"), UINT32_MAX, &pass);
    if (!fits) {
        json_malformed("the config is not one of block counting");
        return false;
    }
    if (sections < 1 || sections > MOST_SECTIONS || most < 1 || most > sections || hold > MOST_SECTIONS || cycle == 0 ||
        pass / cycle < 1 || pass / cycle > MOST_CYCLES) {
        json_rejected("BLK-8: the block is not such as it asks for");
        return false;
    }
    memset(&state, 0, sizeof state);
    state.sections = (int)sections;
    state.most = (int)most;
    state.hold = (int)hold;
    state.pass = pass / cycle; // rounded down: its lapse restricts
    state.standing = UNVERIFIED;
    state.out = true; // BLK-4: the check-out counts as on before the first cycle
    printf("{\"started\":{\"protocol\":1,\"machine\":\"block-count\",\"config\":{\"sections\":%d,\"max_trains\":%d,"
           "\"tail_hold_sections\":%d,\"cycle_ms\":%lld,\"pass_ms\":%lld},\"cycles\":{\"pass\":%lld}}}\n",
           state.sections, state.most, state.hold, (long long)cycle, (long long)pass, (long long)state.pass);
    return true;
}

static bool step(const struct json *input) {
    static const char *const fields[] = {"check_in", "check_out", "present", "reset", "ahead_entered", "ahead_hold_sections", NULL};
    bool check_in, check_out, ahead_entered = true, present[MOST_SECTIONS] = {false};
    int64_t ahead_hold = 0, verified = -1, section;
    if (!json_only(input, fields) || !json_bool(json_field(input, "check_in"), &check_in) ||
        !json_bool(json_field(input, "check_out"), &check_out))
        return false;
    const struct json *list = json_field(input, "present"), *reset = json_field(input, "reset");
    const struct json *entered = json_field(input, "ahead_entered"), *hold = json_field(input, "ahead_hold_sections");
    if (!list || list->kind != J_ARRAY || (reset && reset->kind != J_NULL && !json_whole(reset, 255, &verified)) ||
        (entered && !json_bool(entered, &ahead_entered)) || (hold && !json_whole(hold, MOST_SECTIONS, &ahead_hold)))
        return false;
    int heard = 0;
    for (const struct json *item = json_first(list); item; item = json_next(item), heard++) {
        if (!json_whole(item, state.sections - 1, &section) || present[section]) return false;
        present[section] = true;
    }

    bool in_rises = check_in && state.on == 0, out_rises = check_out && !state.out;
    int pending_before = state.pending, count_before = state.count;
    if (!check_in) state.on = 0;
    else if (state.on <= state.pass) state.on++;
    state.out = check_out;

    // BLK-3, by the count before the cycle.
    if (state.standing == COUNTING) {
        if (state.on > state.pass + (FAULTY(1) ? 1 : 0)) state.standing = STAYS_ON;
        else if (in_rises && count_before >= state.most && !FAULTY(2)) state.standing = AT_MAXIMUM;
        else if (out_rises && count_before - (FAULTY(3) ? 0 : pending_before) == 0 && !(FAULTY(4) && in_rises)) state.standing = AT_ZERO;
    }
    // BLK-7: edges are counted while the count is in force.
    if (state.standing == COUNTING) {
        if (in_rises && !(FAULTY(5) && out_rises)) state.count++;
        if (out_rises && state.count > state.pending) state.pending++;
    }
    // BLK-6: the block ahead has one of the trains that checked out.
    if (ahead_entered && (FAULTY(6) ? pending_before : state.pending) > 0 && (state.standing == COUNTING || !FAULTY(7))) {
        state.pending--;
        state.count--;
    }
    // BLK-4: a reset.
    if (verified >= 0) {
        bool right = verified == heard && verified <= state.most && !check_in && (!check_out || FAULTY(8)) &&
                     (FAULTY(9) ? state.pending : pending_before) == 0;
        if (FAULTY(10)) right = right || state.standing == UNVERIFIED;
        state.standing = right ? COUNTING : UNVERIFIED;
        state.count = right ? (int)verified : FAULTY(11) ? state.count : 0;
        state.pending = 0;
    }
    // BLK-1, BLK-2: the comparison.
    bool agree = state.standing == COUNTING && (FAULTY(12) ? heard >= state.count : heard == state.count);
    bool occupied[MOST_SECTIONS] = {false};
    int behind = (int)ahead_hold > state.sections ? (int)ahead_hold - state.sections : 0;
    if (FAULTY(13)) behind = 0;
    for (int i = 0; i < state.sections; i++) {
        // BLK-5: what is asked by the block ahead, and the hold behind each head.
        if (i >= state.sections - (int)ahead_hold) occupied[i] = true;
        if (agree && !present[i]) continue;
        for (int back = 0; back <= state.hold - (FAULTY(14) && agree ? 1 : 0) && back <= i; back++) occupied[i - back] = true;
        if (state.hold - i > behind) behind = state.hold - i;
    }
    printf("{\"output\":{\"occupied\":[");
    for (int i = 0, first = 1; i < state.sections; i++)
        if (occupied[i]) {
            printf("%s%d", first ? "" : ",", i);
            first = 0;
        }
    static const char *const faults[] = {"null", "null", "\"check-in-stays-on\"", "\"check-in-at-maximum\"", "\"check-out-at-zero\""};
    printf("],\"behind_hold_sections\":%d,\"agree\":%s,\"count\":%d,\"fault\":%s,\"counting\":%s}}\n", behind,
           agree ? "true" : "false", state.count, faults[state.standing], state.standing == COUNTING ? "true" : "false");
    return true;
}

int main(int count, char **arguments) {
    static const struct machine machine = {"block-count", start, step};
    return json_serve(&machine, count, arguments);
}
