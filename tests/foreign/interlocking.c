// Interlocking and ATC, written from spec/interlocking.md alone, without the kernel. It speaks protocol 1 of
// oracle/README.md, for a plan in the kernel's own terms, which it takes as one that keeps the rules of LAY-1.
// Build: gcc -std=c11 -Wall -Wextra -Werror -O1 interlocking.c -o interlocking; with --fault 1 to 38 it has a fault on purpose.
#include "json.h"

enum { CIRCUITS = 64, POINTS = 32, ROUTES = 64, PLACES = 16, SEGMENTS = 8, CODES = 8, NAME = 64 };
enum position { NOWHERE, NORMAL, REVERSE };
enum travel { NEITHER, TOWARD, AWAY };
enum phase { IDLE, PROVISIONAL, FAILED, SET, IN_USE, RELEASING };
enum rear { APPROACH, ENTRY, SWEPT };

typedef uint64_t set; // of circuits, or of routes

struct needs {
    enum position of[POINTS]; // NOWHERE: does not matter
};

struct route {
    char name[NAME];
    bool right, cab, calling; // heading; every train acts on telegrams alone; a calling-on route, whose overlap is the berth
    int entry, length, from, to; // circuit; places; segments or -1
    set approach, path, overlap, beyond, continuing, conflicts;
    int place[PLACES];
    struct needs needs[PLACES], overlap_needs;
    set beside[PLACES], overlap_beside; // where a vehicle would be in the way, and the route does not run
    int64_t drive, release, stay;
    int code, overlap_code;
};

struct segment {
    char name[NAME];
    int length, shared, throat, circuit[CIRCUITS];
    set circuits;
    bool right; // the direction of travel away from the station
};

struct route_state {
    enum phase phase;
    int tail, head;
    bool overlap, proved; // the overlap is held; was set since it was reserved
    enum rear rear;
    int64_t driving, since, stood; // cycles
};

struct grant {
    int from, end, to; // circuits; the segment that it leads out to, or -1
    bool right;
    set circuits;
};

static struct {
    int circuits, points, routes, segments, codes;
    char circuit[CIRCUITS][NAME], point[POINTS][NAME];
    int64_t metres[CIRCUITS], line[CIRCUITS], speed[CODES], braking[CODES]; // the line's code in a circuit
    set detectors[POINTS];
    struct route route[ROUTES];
    struct segment segment[SEGMENTS];
    int64_t clear, settle, turn, start;
} plan;

static struct {
    set occupied, blocked, confirmed;
    int64_t seen_clear[CIRCUITS], stood[POINTS], turned[SEGMENTS], cycles;
    int limit[CIRCUITS];
    enum position stands[POINTS], drives[POINTS]; // as detected, and as driven, in the cycle before
    enum travel travel[SEGMENTS], before[SEGMENTS];
    struct route_state route[ROUTES];
    set unswept, ran; // circuits; routes, of the cycle before
    int64_t still;
} now;

// Of one cycle.
static enum position detected[POINTS], settled[POINTS];
static set consent; // of segments
static bool proceed[ROUTES];
static set kept[ROUTES], kept_beside, running; // by each route; beside that; routes
static bool kept_point[POINTS];

static set one(int circuit) { return (set)1 << circuit; }

// ---- the plan -----------------------------------------------------------------------------------------------------

static int find(const struct json *name, const char *names, size_t stride, int count) {
    if (!name || name->kind != J_STRING) return -1;
    for (int i = 0; i < count; i++)
        if (strcmp(names + (size_t)i * stride, name->text) == 0) return i;
    return -1;
}

static int find_circuit(const struct json *name) { return find(name, plan.circuit[0], NAME, plan.circuits); }
static int find_point(const struct json *name) { return find(name, plan.point[0], NAME, plan.points); }
static int find_route(const struct json *name) { return find(name, plan.route[0].name, sizeof plan.route[0], plan.routes); }
static int find_segment(const struct json *name) { return find(name, plan.segment[0].name, sizeof plan.segment[0], plan.segments); }

// A list of names, each known, as a set; false where it is none.
static bool names(const struct json *list, int (*look)(const struct json *), set *out) {
    *out = 0;
    if (!list || list->kind != J_ARRAY) return false;
    for (const struct json *item = json_first(list); item; item = json_next(item)) {
        int at = look(item);
        if (at < 0 || (*out & one(at))) return false;
        *out |= one(at);
    }
    return true;
}

static bool name(const struct json *value, char *out) {
    if (!value || value->kind != J_STRING || value->size >= NAME) return false;
    strcpy(out, value->text);
    return true;
}

static bool one_of(const struct json *value, const char *no, const char *yes, bool *out) {
    if (!value || value->kind != J_STRING) return false;
    *out = strcmp(value->text, yes) == 0;
    return *out || strcmp(value->text, no) == 0;
}

static bool position(const struct json *value, enum position *out) {
    bool reverse;
    if (!one_of(value, "normal", "reverse", &reverse)) return false;
    *out = reverse ? REVERSE : NORMAL;
    return true;
}

static bool element(const struct json *value, set *circuits, struct needs *needs, set *beside) {
    const struct json *points = value->kind == J_OBJECT ? json_field(value, "points") : NULL;
    if (!points || points->kind != J_OBJECT || !names(json_field(value, "circuits"), find_circuit, circuits)) return false;
    const struct json *near = json_field(value, "beside");
    *beside = 0;
    if (near && !names(near, find_circuit, beside)) return false;
    for (const struct json *item = json_first(points); item; item = json_next(item)) {
        struct json key = {.kind = J_STRING, .text = item->key};
        int at = find_point(&key);
        if (at < 0 || !position(item, &needs->of[at])) return false;
    }
    return true;
}

static int lowest(set circuits) {
    for (int i = 0; i < CIRCUITS; i++)
        if (circuits & one(i)) return i;
    return -1;
}

static bool read_route(const struct json *value, struct route *route) {
    set entry, from, to, circuits;
    int64_t code = 0, beyond = -1;
    const struct json *beside = json_field(value, "overlap_speed_code");
    const struct json *path = json_field(value, "path"), *overlap = json_field(value, "overlap"), *cab = json_field(value, "cab_signalled");
    const struct json *calling = json_field(value, "calling_on");
    if (!one_of(json_field(value, "heading"), "left", "right", &route->right) ||
        !names(json_field(value, "entry"), find_circuit, &entry) || !names(json_field(value, "approach"), find_circuit, &route->approach) ||
        !names(json_field(value, "beyond"), find_circuit, &route->beyond) ||
        !names(json_field(value, "continuing"), find_route, &route->continuing) ||
        !names(json_field(value, "conflicts"), find_route, &route->conflicts) || !names(json_field(value, "from"), find_segment, &from) ||
        !names(json_field(value, "to"), find_segment, &to) || !json_whole(json_field(value, "drive_cycles"), 65535, &route->drive) ||
        !json_whole(json_field(value, "release_cycles"), 65535, &route->release) ||
        !json_whole(json_field(value, "stay_cycles"), 65535, &route->stay) || !json_whole(json_field(value, "speed_code"), 7, &code) ||
        (beside && beside->kind != J_NULL && !json_whole(beside, 7, &beyond)) ||
        (cab && !json_bool(cab, &route->cab)) || (calling && !json_bool(calling, &route->calling)) || !path || path->kind != J_ARRAY || path->size < 1 || path->size > PLACES || !overlap ||
        !element(overlap, &route->overlap, &route->overlap_needs, &route->overlap_beside) || !entry)
        return false;
    route->entry = lowest(entry);
    route->from = from ? lowest(from) : -1;
    route->to = to ? lowest(to) : -1;
    route->code = (int)code;
    route->overlap_code = beyond < 0 ? (int)code : (int)beyond;
    for (const struct json *item = json_first(path); item; item = json_next(item)) {
        if (!element(item, &circuits, &route->needs[route->length], &route->beside[route->length]) || !circuits) return false;
        route->place[route->length++] = lowest(circuits);
        route->path |= circuits;
    }
    return true;
}

static bool read_segment(const struct json *value, struct segment *segment) {
    set throat;
    int64_t shared = 0;
    const struct json *circuits = json_field(value, "circuits");
    if (!name(json_field(value, "name"), segment->name) || !names(circuits, find_circuit, &segment->circuits) ||
        !names(json_field(value, "throat"), find_circuit, &throat) ||
        !one_of(json_field(value, "outward"), "left", "right", &segment->right) ||
        (json_field(value, "shared") && !json_whole(json_field(value, "shared"), 255, &shared)))
        return false;
    for (const struct json *item = json_first(circuits); item; item = json_next(item)) segment->circuit[segment->length++] = find_circuit(item);
    segment->throat = throat ? lowest(throat) : -1;
    segment->shared = (int)shared;
    return true;
}

static bool numbers(const struct json *list, int64_t *out, int *count) {
    if (!list || list->kind != J_ARRAY || list->size > CODES) return false;
    *count = 0;
    for (const struct json *item = json_first(list); item; item = json_next(item))
        if (!json_whole(item, 65535, &out[(*count)++])) return false;
    return true;
}

static bool read_circuit(const struct json *value, int circuit) {
    const struct json *limit = json_field(value, "speed_code");
    plan.line[circuit] = CODES - 1;
    return name(json_field(value, "name"), plan.circuit[circuit]) &&
           json_whole(json_field(value, "length_m"), 65535, &plan.metres[circuit]) &&
           (!limit || json_whole(limit, CODES - 1, &plan.line[circuit]));
}

static bool read_plan(const struct json *value) {
    const struct json *circuits = json_field(value, "circuits"), *points = json_field(value, "points");
    const struct json *routes = json_field(value, "routes"), *segments = json_field(value, "segments"), *item;
    int distances = 0, at = 0;
    if (!circuits || circuits->kind != J_ARRAY || circuits->size > CIRCUITS || !points || points->kind != J_ARRAY ||
        points->size > POINTS || !routes || routes->kind != J_ARRAY || routes->size > ROUTES || !segments || segments->kind != J_ARRAY ||
        segments->size > SEGMENTS || !json_whole(json_field(value, "clear_cycles"), 255, &plan.clear) ||
        !json_whole(json_field(value, "turn_cycles"), 65535, &plan.turn) ||
        (json_field(value, "settle_cycles") && !json_whole(json_field(value, "settle_cycles"), 255, &plan.settle)) ||
        (json_field(value, "start_cycles") && !json_whole(json_field(value, "start_cycles"), 65535, &plan.start)) ||
        !numbers(json_field(value, "speeds_km_h"), plan.speed, &plan.codes) ||
        !numbers(json_field(value, "braking_m"), plan.braking, &distances) || distances != plan.codes)
        return false;
    for (item = json_first(circuits); item; item = json_next(item), plan.circuits++)
        if (item->kind != J_OBJECT || !read_circuit(item, plan.circuits)) return false;
    for (item = json_first(points); item; item = json_next(item), plan.points++)
        if (item->kind != J_OBJECT || !name(json_field(item, "name"), plan.point[plan.points]) ||
            !names(json_field(item, "detectors"), find_circuit, &plan.detectors[plan.points]))
            return false;
    for (item = json_first(segments); item; item = json_next(item), plan.segments++)
        if (item->kind != J_OBJECT || !read_segment(item, &plan.segment[plan.segments])) return false;
    // The names of all routes first: routes name each other.
    for (item = json_first(routes); item; item = json_next(item), plan.routes++)
        if (item->kind != J_OBJECT || !name(json_field(item, "name"), plan.route[plan.routes].name)) return false;
    for (item = json_first(routes); item; item = json_next(item), at++)
        if (!read_route(item, &plan.route[at])) return false;
    return true;
}

static bool start(const struct json *config) {
    static const char *const fields[] = {"plan", NULL};
    const struct json *value = json_only(config, fields) ? json_field(config, "plan") : NULL;
    memset(&plan, 0, sizeof plan);
    memset(&now, 0, sizeof now);
    if (!value || value->kind != J_OBJECT || !read_plan(value)) {
        json_malformed("the config is not one with a plan");
        return false;
    }
    // The most restrictive state: everything occupied, blocked and restricted to stop.
    now.unswept = now.ran = ~(set)0;
    now.occupied = now.blocked = plan.circuits == CIRCUITS ? ~(set)0 : one(plan.circuits) - 1;
    printf("{\"started\":{\"protocol\":1,\"machine\":\"interlocking\"}}\n");
    return true;
}

// ---- what a route holds -------------------------------------------------------------------------------------------

static set held_path(int r) {
    set circuits = 0;
    if (now.route[r].phase == IDLE) return 0;
    for (int i = now.route[r].tail; i < plan.route[r].length; i++) circuits |= one(plan.route[r].place[i]);
    return circuits;
}

static set held_overlap(int r) { return now.route[r].phase != IDLE && now.route[r].overlap ? plan.route[r].overlap : 0; }

// What must be clear beside what a route holds; of a route that holds nothing, nothing.
static set held_beside(int r) {
    set circuits = 0;
    if (now.route[r].phase == IDLE || FAULTY(41)) return 0;
    for (int i = now.route[r].tail; i < plan.route[r].length; i++) circuits |= plan.route[r].beside[i];
    return circuits | (now.route[r].overlap ? plan.route[r].overlap_beside : 0);
}

static set all_beside(int r) {
    set circuits = plan.route[r].overlap_beside;
    for (int i = 0; i < plan.route[r].length; i++) circuits |= plan.route[r].beside[i];
    return circuits;
}

static enum position held_point(int r, int point) {
    if (now.route[r].phase == IDLE) return NOWHERE;
    for (int i = now.route[r].tail; i < plan.route[r].length; i++)
        if (plan.route[r].needs[i].of[point]) return plan.route[r].needs[i].of[point];
    return now.route[r].overlap ? plan.route[r].overlap_needs.of[point] : NOWHERE;
}

static enum position wanted_point(int r, int point) {
    for (int i = 0; i < plan.route[r].length; i++)
        if (plan.route[r].needs[i].of[point]) return plan.route[r].needs[i].of[point];
    return plan.route[r].overlap_needs.of[point];
}

static set line_and_throat(int s) { return plan.segment[s].circuits | (plan.segment[s].throat < 0 ? 0 : one(plan.segment[s].throat)); }

static bool somebody_behind_entry(const struct route *route) { return (route->approach & ~one(route->entry) & now.occupied) != 0; }
// A train that comes to the signal would run over a block.
static bool cut_off(const struct route *route) { return somebody_behind_entry(route) && (route->approach & now.blocked); }
static bool line_blocked(int s) { return (plan.segment[s].circuits & now.blocked) != 0; }

static bool out_allowed(int r) {
    int s = plan.route[r].to;
    return s < 0 || (!line_blocked(s) && ((consent & one(s)) || FAULTY(15)) && now.travel[s] == AWAY);
}

// ---- routes follow their trains -----------------------------------------------------------------------------------

static void idle(int r) { memset(&now.route[r], 0, sizeof now.route[r]); }

static void follow_rear(int r, bool set_still) {
    const struct route *route = &plan.route[r];
    struct route_state *state = &now.route[r];
    bool outer_clear = !somebody_behind_entry(route), entry_clear = !(one(route->entry) & now.occupied);
    if (set_still) {
        if (!route->cab) state->rear = APPROACH;
        else if (outer_clear) state->rear = ENTRY;
        else if (entry_clear) state->rear = APPROACH;
        return;
    }
    if (state->rear == APPROACH && outer_clear) state->rear = ENTRY;
    if (state->rear == ENTRY && entry_clear) state->rear = SWEPT;
    if (state->since >= route->release || FAULTY(3)) state->rear = SWEPT;
}

static void follow(int r) {
    const struct route *route = &plan.route[r];
    struct route_state *state = &now.route[r];
    if (state->phase == SET) {
        if (route->path & now.occupied) {
            state->phase = IN_USE;
            state->since = 0;
        } else {
            follow_rear(r, true);
            return;
        }
    } else if (state->phase == IN_USE || state->phase == RELEASING) {
        if (state->since < route->release) state->since++;
    } else {
        return;
    }
    if (state->proved) {
        follow_rear(r, false);
        if (state->head < route->length) {
            int before = state->head > 0 ? route->place[state->head - 1] : route->entry;
            if ((now.occupied & one(route->place[state->head])) && ((now.occupied & one(before)) || (route->calling && !state->head) || FAULTY(6))) state->head++;
        }
        int last = route->length - 1;
        bool last_occupied = last >= 0 && (now.occupied & one(route->place[last]));
        bool overlap_clear = !(route->overlap & now.occupied);
        // One place.
        if (state->tail < state->head && state->rear == SWEPT && !(now.occupied & one(route->place[state->tail]))) {
            bool further = state->tail == last ? (now.occupied & route->beyond) != 0 || FAULTY(5) : state->tail + 1 < state->head || FAULTY(4);
            if (further) state->tail++;
            if (FAULTY(36) && further && state->tail < state->head && !(now.occupied & one(route->place[state->tail]))) state->tail++;
        }
        // The overlap.
        if (state->tail == last && !route->calling && state->head == route->length && (state->rear == SWEPT || FAULTY(32)) && last_occupied &&
            (route->length > 1 || state->stood > 0 || !(now.occupied & one(route->entry)) || FAULTY(23))) {
            if (state->stood < route->stay) state->stood++;
        } else {
            state->stood = 0;
        }
        bool stands = state->tail == last && !route->calling && state->stood + (FAULTY(31) ? 1 : 0) >= route->stay;
        if (state->overlap && overlap_clear && (state->tail == route->length || stands)) state->overlap = false;
        if (state->tail == route->length && !state->overlap) {
            idle(r);
            return;
        }
    }
    set all = held_path(r) | (route->calling && !state->head ? 0 : held_overlap(r));
    if (state->phase == RELEASING && state->since >= route->release && (!(all & now.occupied) || FAULTY(9))) idle(r);
}

// ---- what a start leaves unswept ----------------------------------------------------------------------------------

static void keep(int r, set *circuits) {
    const struct route *route = &plan.route[r];
    int first = -1;
    if (route->cab || (route->overlap & ~now.unswept)) return;
    for (int i = 0; i < route->length; i++) {
        if (!(now.unswept & one(route->place[i]))) first = -1;
        else if (first < 0 && (now.occupied & one(route->place[i]))) first = i;
    }
    bool alone = route->length == 1 && (now.occupied & one(route->entry));
    bool runs = first >= 0 && (first < route->length - 1 || alone || route->calling);
    bool stops = (now.ran & one(r)) || now.still < route->stay;
    bool called = route->calling && (route->overlap & now.occupied);
    if (!runs && !called && !(stops && (first >= 0 || (route->overlap & now.occupied)))) return;
    if (runs) running |= one(r);
    *circuits = route->overlap;
    kept_beside |= route->overlap_beside;
    for (int i = first; i >= 0 && i < route->length; i++) kept_beside |= route->beside[i];
    for (int i = first; i >= 0 && i < route->length; i++) *circuits |= one(route->place[i]);
    for (int p = 0; p < plan.points; p++) {
        if (route->overlap_needs.of[p]) kept_point[p] = true;
        for (int i = first; i >= 0 && i < route->length; i++)
            if (route->needs[i].of[p]) kept_point[p] = true;
    }
}

static void sweep(bool starting) {
    int64_t longest = 0;
    set all = 0, routes = 0;
    memset(kept, 0, sizeof kept);
    memset(kept_point, 0, sizeof kept_point);
    kept_beside = 0;
    running = 0;
    if (starting) return;
    for (int r = 0; r < plan.routes; r++) {
        keep(r, &kept[r]);
        all |= kept[r];
        routes |= one(r);
        if (plan.route[r].stay > longest) longest = plan.route[r].stay;
    }
    if (!all || (now.ran & routes & ~running)) now.still = 0;
    else if (now.still < longest) now.still++;
    now.unswept = FAULTY(37) ? 0 : all;
    now.ran = running;
}

// Whether what a route keeps is in the way of another one.
static bool in_the_way(int r) {
    const struct route *route = &plan.route[r];
    set needed = route->path | route->overlap, near = all_beside(r);
    for (int other = 0; other < plan.routes; other++) {
        const struct route *its = &plan.route[other];
        bool own = false, begins = false;
        for (int i = 0; i < its->length; i++) {
            bool meets = needed & one(its->place[i]);
            own = own && meets;
            if (meets && !own && (kept[other] & one(its->place[i]))) return true;
            if (its->place[i] == route->entry && its->right == route->right) own = begins = true;
            own = own && !route->calling;
            // At the end of its route the train may be the one that goes on.
            bool ends = i == its->length - 1 && its->to < 0 && !(its->overlap & now.occupied);
            bool his = ends && own && its->place[i] == route->entry && its->right == route->right;
            bool strikes = (its->beside[i] & needed) || (near & one(its->place[i]));
            if (strikes && !his && (kept[other] & one(its->place[i]))) return true;
        }
        if (kept[other] && ((its->overlap_beside & needed) || (near & its->overlap))) return true;
        if ((needed & its->overlap & kept[other]) && (!own || (its->overlap & now.occupied))) return true;
        if (kept[other] && (route->conflicts & one(other)) && !begins && !(needed & (its->path | its->overlap))) return true;
    }
    return false;
}

// ---- requests -----------------------------------------------------------------------------------------------------

static const char *set_route(int r) {
    const struct route *route = &plan.route[r];
    struct route_state *state = &now.route[r];
    if (state->phase == RELEASING && state->head > 0) {
        if (((held_path(r) | (route->calling ? held_overlap(r) : 0)) & now.blocked) || (route->to >= 0 && line_blocked(route->to))) return "blocked";
        state->phase = IN_USE;
        return NULL;
    }
    if (state->phase != IDLE) return "already-held";
    for (int other = 0; other < plan.routes; other++) {
        if (now.route[other].phase == IDLE) continue;
        set path = held_path(other), overlap = held_overlap(other);
        if ((route->conflicts & one(other)) && !FAULTY(11)) return "conflict";
        bool stands = !now.route[other].overlap && now.route[other].tail == plan.route[other].length - 1;
        bool after = route->continuing & one(other), before = plan.route[other].continuing & one(r);
        bool beside = after || (route->calling && stands);
        set theirs = overlap | (after ? 0 : path), mine = route->overlap | (before ? 0 : route->path);
        if ((route->path & path) || ((route->path & overlap) && !before)) return "path-held";
        if (((all_beside(r) & theirs) || (held_beside(other) & mine)) && !FAULTY(42)) return "path-held";
        if (((route->overlap & overlap) && !FAULTY(12)) || ((route->overlap & path) && !beside)) return "overlap-held";
        for (int p = 0; p < plan.points; p++) {
            enum position want = wanted_point(r, p), held = held_point(other, p);
            if (want && held && want != held && !FAULTY(13)) return "point-locked";
        }
    }
    if (FAULTY(14) && ((route->path | route->overlap) & now.blocked)) return "blocked";
    if ((route->path | all_beside(r) | (route->calling ? 0 : route->overlap)) & now.occupied) return "occupied";
    if (route->calling && (!(now.occupied & one(route->entry)) || !(now.occupied & route->overlap))) return "not-called-for";
    if (in_the_way(r)) return "unswept";
    for (int p = 0; p < plan.points; p++) {
        enum position want = wanted_point(r, p);
        if (want && want != detected[p] && kept_point[p]) return "unswept";
    }
    if (((route->path | route->overlap | all_beside(r)) & now.blocked) || cut_off(route) || (route->to >= 0 && line_blocked(route->to))) return "blocked";
    for (int p = 0; p < plan.points; p++) {
        enum position want = wanted_point(r, p);
        if (want && want != detected[p] && (plan.detectors[p] & now.blocked)) return "blocked";
    }
    if (route->from >= 0 && now.travel[route->from] != TOWARD) return "direction";
    if (route->to >= 0 && (now.travel[route->to] != AWAY || !(consent & one(route->to)))) return "direction";
    for (int p = 0; p < plan.points; p++) {
        enum position want = wanted_point(r, p);
        if (want && want != detected[p] && (plan.detectors[p] & now.occupied)) return "point-under-train";
    }
    memset(state, 0, sizeof *state);
    state->phase = PROVISIONAL;
    state->overlap = true;
    return NULL;
}

static const char *withdraw(int r) {
    const struct route *route = &plan.route[r];
    struct route_state *state = &now.route[r];
    if (state->phase == IDLE) return "not-held";
    bool path_clear = !(route->path & now.occupied), approach_clear = !state->proved || !(route->approach & now.occupied) || FAULTY(8);
    if (state->phase < IN_USE && path_clear && approach_clear) {
        idle(r);
        return NULL;
    }
    if (!FAULTY(7) || state->phase != RELEASING) state->since = 0;
    state->phase = RELEASING;
    return NULL;
}

static const char *drive(int p) {
    for (int r = 0; r < plan.routes; r++)
        if (held_point(r, p)) return "point-locked";
    for (int r = 0; r < plan.routes; r++)
        if ((held_path(r) | held_overlap(r)) & plan.detectors[p]) return "path-held";
    if (plan.detectors[p] & now.occupied) return "point-under-train";
    if (kept_point[p]) return "unswept";
    if (plan.detectors[p] & now.blocked) return "blocked";
    return NULL;
}

static const char *turn_toward(int s) {
    bool in = false, out = false, one_way = now.travel[s] == NEITHER, clear = !(line_and_throat(s) & now.occupied);
    for (int r = 0; r < plan.routes; r++) {
        in = in || plan.route[r].from == s;
        out = out || (plan.route[r].to == s && (now.route[r].phase != IDLE || (running & one(r))));
        one_way = one_way && plan.route[r].to != s;
    }
    if (line_blocked(s)) return "blocked";
    if (now.travel[s] == TOWARD) return NULL;
    if (out || !in || (!clear && now.before[s] != TOWARD && !one_way && !FAULTY(18))) return "direction";
    now.travel[s] = now.before[s] = TOWARD;
    return NULL;
}

static const char *turn_away(int s) {
    bool clear = !(line_and_throat(s) & now.occupied);
    if (now.travel[s] == AWAY) return NULL;
    for (int r = 0; r < plan.routes; r++)
        if (plan.route[r].from == s && now.route[r].phase != IDLE && now.route[r].tail == 0) return "direction";
    if (!clear) return "direction";
    if (!(consent & one(s)) || now.turned[s] < plan.turn - (FAULTY(16) ? 1 : 0) || line_blocked(s)) {
        if (!FAULTY(17)) now.travel[s] = NEITHER;
        return "waiting";
    }
    now.travel[s] = now.before[s] = AWAY;
    return NULL;
}

// ---- signals, grants and telegrams --------------------------------------------------------------------------------

static bool point_sound(int p, enum position need) { return !need || (settled[p] == need && !now.drives[p]); }

static bool points_sound(int r, int place) {
    if (plan.route[r].beside[place] & (now.occupied | now.blocked) && !FAULTY(41)) return false;
    for (int p = 0; p < plan.points; p++)
        if (!point_sound(p, plan.route[r].needs[place].of[p])) return false;
    return true;
}

static bool place_sound(int r, int place) { return !(now.blocked & one(plan.route[r].place[place])) && points_sound(r, place); }

static bool all_points_sound(int r) {
    for (int p = 0; p < plan.points; p++)
        if (!point_sound(p, held_point(r, p))) return false;
    return true;
}

static bool clear_and_unblocked(int r) {
    set clear = held_path(r) | (plan.route[r].calling ? 0 : held_overlap(r));
    set near = held_beside(r);
    return !((clear | near) & now.occupied) && !cut_off(&plan.route[r]) && !((held_path(r) | held_overlap(r) | near) & now.blocked);
}

static struct grant grants[ROUTES + CIRCUITS];
static int granted;

static void grant(int from, int end, int to, bool right, set circuits) {
    if (circuits) grants[granted++] = (struct grant){from, end, to, right, circuits};
}

// The circuits of a segment outward from place `i` on that are free and unblocked.
static void grant_line(int s, int from, int i, int by) {
    const struct segment *segment = &plan.segment[s];
    set circuits = 0;
    int end = from;
    for (; i >= 0 && i < segment->length && !((now.occupied | now.blocked) & one(segment->circuit[i])); i += by) {
        circuits |= one(segment->circuit[i]);
        end = segment->circuit[i];
    }
    grant(from, end, -1, by > 0 ? segment->right : !segment->right, circuits);
}

static bool outward(int s) { return now.travel[s] == AWAY && (consent & one(s)); }

static void find_grants(void) {
    granted = 0;
    for (int r = 0; r < plan.routes; r++) {
        const struct route *route = &plan.route[r];
        const struct route_state *state = &now.route[r];
        if (proceed[r]) {
            grant(route->entry, route->place[route->length - 1], route->to, route->right, route->path);
        } else if (state->phase == IN_USE || (state->phase == RELEASING && FAULTY(10))) {
            int front = -1;
            for (int i = state->tail; i < route->length; i++)
                if (now.occupied & one(route->place[i])) front = i;
            if (front < 0 || front >= state->head || !(points_sound(r, front) || FAULTY(24))) continue;
            set circuits = 0;
            int end = front;
            while (end + 1 < route->length && (place_sound(r, end + 1) || FAULTY(29))) circuits |= one(route->place[++end]);
            grant(route->place[front], route->place[end], end == route->length - 1 ? route->to : -1, route->right, circuits);
            // The train in the throat.
            if (front == route->length - 1 && route->to >= 0 && outward(route->to)) grant_line(route->to, route->place[front], 0, 1);
        }
    }
    for (int s = 0; s < plan.segments; s++)
        for (int i = 0; i < plan.segment[s].length; i++) {
            if (!(now.occupied & one(plan.segment[s].circuit[i]))) continue;
            if (now.travel[s] == TOWARD) grant_line(s, plan.segment[s].circuit[i], i - 1, -1);
            if (outward(s)) grant_line(s, plan.segment[s].circuit[i], i + 1, 1);
        }
}

static const struct grant *grant_from(int circuit) {
    const struct grant *found = NULL;
    for (int i = 0; i < granted; i++) {
        if (grants[i].from != circuit) continue;
        if (found) return NULL; // ATC-2: it is not known whose train stands there
        found = &grants[i];
    }
    return found;
}

static int circuit_limit(int circuit) {
    int limit = now.limit[circuit], over = plan.codes - 1, held = plan.codes - 1;
    bool is_held = false;
    for (int r = 0; r < plan.routes; r++) {
        if (plan.route[r].calling && (held_overlap(r) & one(circuit)) && plan.route[r].code < limit) limit = plan.route[r].code;
        if (plan.route[r].path & one(circuit) && plan.route[r].code < over && !FAULTY(26)) over = plan.route[r].code;
        if (plan.route[r].overlap & one(circuit) && plan.route[r].overlap_code < over && !FAULTY(39)) over = plan.route[r].overlap_code;
        if (held_path(r) & one(circuit)) {
            is_held = true;
            if (plan.route[r].code < held) held = plan.route[r].code;
        }
    }
    if (is_held) over = held;
    if (plan.line[circuit] < limit && !FAULTY(40)) limit = (int)plan.line[circuit];
    return over < limit ? over : limit;
}

// The occupied circuits of a segment and its throat that follow on the given ones without a gap.
static set along_line(int s, set circuits) {
    const struct segment *segment = &plan.segment[s];
    for (int round = 0; round < 2; round++) {
        bool in = segment->throat >= 0 && (circuits & one(segment->throat));
        for (int i = 0; i < segment->length; i++) {
            in = (circuits & one(segment->circuit[i])) || (in && (now.occupied & one(segment->circuit[i])));
            if (in) circuits |= one(segment->circuit[i]);
        }
        in = false;
        for (int i = segment->length - 1; i >= -1; i--) {
            int at = i >= 0 ? segment->circuit[i] : segment->throat;
            if (at < 0) break;
            in = (circuits & one(at)) || (in && (now.occupied & one(at)));
            if (in) circuits |= one(at);
        }
    }
    return circuits;
}

static set body(int front) {
    set circuits = one(front), known = 0;
    for (int s = 0; s < plan.segments; s++) known |= plan.segment[s].circuits;
    for (int r = 0; r < plan.routes; r++) known |= held_path(r);
    for (int round = 0; round < 5; round++) {
        set more = circuits;
        for (int r = 0; r < plan.routes; r++) {
            set held = held_path(r);
            set last = held ? one(plan.route[r].place[plan.route[r].length - 1]) : 0;
            if (held && now.route[r].tail == 0) held |= one(plan.route[r].entry);
            if (last & now.occupied) held |= held_overlap(r);
            if (held & circuits) more |= held & now.occupied;
        }
        for (int s = 0; s < plan.segments; s++) more |= along_line(s, circuits);
        if (more & ~known) return now.occupied;
        circuits = more;
    }
    return circuits;
}

static void put_name(bool *first, const char *text) {
    printf("%s\"%s\"", *first ? "" : ",", text);
    *first = false;
}

static void telegram(bool *first, int circuit, bool all) {
    int stop = circuit, at = circuit, code = 0;
    set circuits = 0;
    const struct grant *next = now.occupied & one(circuit) ? grant_from(circuit) : NULL;
    bool right = next && next->right;
    for (int i = 0; i < (FAULTY(28) ? 3 : 4) && next && next->right == right; i++) {
        circuits |= next->circuits;
        at = next->end;
        struct grant line = {0};
        int to = FAULTY(30) ? -1 : next->to;
        next = grant_from(at);
        if (to >= 0 && plan.segment[to].throat == at && outward(to)) {
            int before = granted;
            grant_line(to, at, 0, 1);
            if (granted > before) {
                line = grants[granted - 1];
                granted = before;
                next = next ? NULL : &line;
                if (next && i + 1 < 4 && next->right == right) {
                    circuits |= line.circuits;
                    at = line.end;
                }
                next = NULL;
            }
        }
    }
    if (circuits) {
        int64_t distance = FAULTY(27) ? plan.metres[circuit] : 0;
        set under = FAULTY(25) ? 0 : body(circuit);
        for (int c = 0; c < plan.circuits; c++)
            if (circuits & one(c)) distance += plan.metres[c];
        for (int i = 0; i < plan.codes; i++)
            if (plan.braking[i] <= distance) code = i;
        for (int c = 0; c < plan.circuits; c++)
            if (((circuits | under) & one(c)) && circuit_limit(c) < code) code = circuit_limit(c);
        stop = at;
    } else if (!all) {
        return;
    }
    put_name(first, plan.circuit[circuit]);
    printf(":{\"stop\":\"%s\",\"speed_km_h\":%lld,\"open\":%s,\"heading\":%s}", plan.circuit[stop], (long long)plan.speed[code],
           circuits ? "true" : "false", !circuits ? "null" : right ? "\"right\"" : "\"left\"");
}

// ---- one cycle ----------------------------------------------------------------------------------------------------

struct orders {
    set block, unblock, lift, restrict_;
    int code;
};

static bool read_orders(const struct json *value, struct orders *orders) {
    static const char *const fields[] = {"block", "unblock", "lift", "restrict", NULL};
    memset(orders, 0, sizeof *orders);
    if (!value) return true;
    if (!json_only(value, fields)) return false;
    const struct json *block = json_field(value, "block"), *unblock = json_field(value, "unblock");
    const struct json *lift = json_field(value, "lift"), *limits = json_field(value, "restrict");
    if ((block && !names(block, find_circuit, &orders->block)) || (unblock && !names(unblock, find_circuit, &orders->unblock)) ||
        (lift && !names(lift, find_circuit, &orders->lift)) || (limits && limits->kind != J_OBJECT))
        return false;
    int64_t all = -1, speed;
    for (const struct json *item = limits ? json_first(limits) : NULL; item; item = json_next(item)) {
        struct json key = {.kind = J_STRING, .text = item->key};
        int at = find_circuit(&key);
        if (at < 0 || !json_whole(item, 65535, &speed) || (all >= 0 && speed != all)) return false;
        all = speed;
        orders->restrict_ |= one(at);
    }
    for (int i = 0; i < plan.codes; i++)
        if (plan.speed[i] <= all) orders->code = FAULTY(34) && i + 1 < plan.codes ? i + 1 : i;
    return true;
}

static bool step(const struct json *input) {
    static const char *const fields[] = {"occupied", "detected", "orders", "request", "consent", "all_telegrams", NULL};
    static const char *const phases[] = {"idle", "provisional", "failed", "set", "in-use", "releasing"};
    set reported;
    struct orders orders;
    bool all = false, first, is_away = false;
    enum position drive_to = NOWHERE;
    int asked = -1, driven = -1;
    if (!json_only(input, fields) || !names(json_field(input, "occupied"), find_circuit, &reported) ||
        !read_orders(json_field(input, "orders"), &orders))
        return false;
    const struct json *list = json_field(input, "detected"), *request = json_field(input, "request");
    consent = 0;
    if (!list || list->kind != J_OBJECT || (json_field(input, "consent") && !names(json_field(input, "consent"), find_segment, &consent)) ||
        (json_field(input, "all_telegrams") && !json_bool(json_field(input, "all_telegrams"), &all)))
        return false;
    memset(detected, 0, sizeof detected);
    for (const struct json *item = json_first(list); item; item = json_next(item)) {
        struct json key = {.kind = J_STRING, .text = item->key};
        int at = find_point(&key);
        if (at < 0 || (item->kind != J_NULL && !position(item, &detected[at]))) return false;
    }
    const struct json *what = NULL, *to = NULL;
    if (request && request->kind == J_NULL) request = NULL;
    if (request) {
        static const char *const one_field[] = {"set", "withdraw", NULL}, *const two_fields[] = {"drive", "turn", "to", NULL};
        if (json_only(request, one_field) && request->size == 1) what = json_first(request);
        else if (json_only(request, two_fields) && request->size == 2) {
            to = json_field(request, "to");
            what = json_field(request, "drive") ? json_field(request, "drive") : json_field(request, "turn");
            if (!to || !what || !(what->key[0] == 'd' ? position(to, &drive_to) : one_of(to, "toward", "away", &is_away))) return false;
        }
        if (!what || what->kind != J_STRING) return false;
        char which = what->key[0];
        asked = which == 's' || which == 'w' ? find_route(what) : which == 'd' ? find_point(what) : find_segment(what);
        if (asked < 0) return false; // a name that is not in the plan is no request
    }

    // Track.
    for (int c = 0; c < plan.circuits; c++) {
        if (reported & one(c)) now.seen_clear[c] = 0;
        else if (now.seen_clear[c] < plan.clear) now.seen_clear[c]++;
        if (now.seen_clear[c] >= plan.clear - (FAULTY(1) ? 1 : 0)) now.occupied &= ~one(c);
        else now.occupied |= one(c);
    }
    for (int p = 0; p < plan.points; p++) {
        if (!detected[p] || detected[p] != now.stands[p]) now.stood[p] = 0;
        else if (now.stood[p] < 255) now.stood[p]++;
        now.stands[p] = detected[p];
        settled[p] = now.stood[p] >= plan.settle || FAULTY(2) ? detected[p] : NOWHERE;
    }
    bool starting = now.cycles < plan.start - (FAULTY(35) ? 1 : 0);
    if (starting) now.cycles++;

    // Orders: a block and a restriction are always carried out.
    now.blocked = (now.blocked & ~orders.unblock) | orders.block;
    if (!FAULTY(20)) now.confirmed &= now.blocked;
    for (int c = 0; c < plan.circuits; c++) {
        if (orders.lift & one(c)) now.limit[c] = plan.codes - 1;
        if (orders.restrict_ & one(c) && orders.code < now.limit[c]) now.limit[c] = orders.code;
    }

    for (int r = 0; r < plan.routes; r++) follow(r);
    sweep(starting);

    // The request.
    const char *refused = NULL;
    if (what) {
        if (starting && what->key[0] != 'w') refused = "starting";
        else if (what->key[0] == 's') refused = set_route(asked);
        else if (what->key[0] == 'w') refused = withdraw(asked);
        else if (what->key[0] == 't') refused = is_away ? turn_away(asked) : turn_toward(asked);
        else if ((refused = drive(asked)) == NULL) driven = asked;
    }

    // The turn time; a block counts on the time before this cycle.
    int64_t waited[SEGMENTS];
    for (int s = 0; s < plan.segments; s++) {
        waited[s] = now.turned[s];
        if (now.travel[s] == TOWARD) now.turned[s] = 0;
        else if (now.turned[s] < plan.turn) now.turned[s]++;
    }

    // Drives.
    for (int p = 0; p < plan.points; p++) {
        enum position want = p == driven ? drive_to : NOWHERE;
        bool locked = kept_point[p];
        for (int r = 0; r < plan.routes; r++) {
            if (now.route[r].phase == PROVISIONAL && held_point(r, p)) want = held_point(r, p);
            if (now.route[r].phase > PROVISIONAL && held_point(r, p)) locked = true;
        }
        now.drives[p] = want && want != detected[p] && !locked && !(plan.detectors[p] & now.blocked) && (!(plan.detectors[p] & now.occupied) || FAULTY(21)) ? want : NOWHERE;
        if (now.drives[p]) now.stood[p] = 0;
    }

    // Reservation.
    for (int r = 0; r < plan.routes; r++) {
        struct route_state *state = &now.route[r];
        if (state->phase != PROVISIONAL) continue;
        if (all_points_sound(r) && clear_and_unblocked(r) && out_allowed(r)) {
            state->phase = SET;
            state->proved = true;
            state->rear = plan.route[r].cab ? ENTRY : APPROACH;
            follow_rear(r, true);
        } else if (++state->driving >= plan.route[r].drive + (FAULTY(22) ? 1 : 0)) {
            state->phase = FAILED;
        }
    }

    // Confirmation.
    set held = kept_beside;
    for (int p = 0; p < plan.points; p++) held |= settled[p] == NOWHERE || now.drives[p] ? plan.detectors[p] : 0;
    for (int r = 0; r < plan.routes; r++) {
        held |= held_path(r) | held_overlap(r) | held_beside(r);
        if (now.route[r].proved && now.route[r].rear == APPROACH && somebody_behind_entry(&plan.route[r])) held |= plan.route[r].approach;
        for (int p = 0; p < plan.points; p++) held |= held_point(r, p) ? plan.detectors[p] : 0;
        // Nobody works beside what stands there.
        for (int i = 0; i <= plan.route[r].length; i++) {
            bool last = i == plan.route[r].length;
            set own = last ? plan.route[r].overlap : one(plan.route[r].place[i]), near = last ? plan.route[r].overlap_beside : plan.route[r].beside[i];
            held |= (near & now.occupied ? own : 0) | (own & now.occupied ? near : 0);
        }
    }
    for (int c = 0; c < plan.circuits && !starting; c++) {
        if (!(now.blocked & one(c)) || ((held | (FAULTY(38) ? 0 : now.unswept)) & one(c)) || (now.occupied & one(c))) continue;
        bool safe = true;
        for (int s = 0; s < plan.segments; s++) {
            if (!(plan.segment[s].circuits & one(c))) continue;
            if (((FAULTY(19) ? plan.segment[s].circuits : line_and_throat(s)) & now.occupied) || now.travel[s] == TOWARD || waited[s] < plan.turn) safe = false;
            for (int r = 0; r < plan.routes; r++)
                if (plan.route[r].to == s && (now.route[r].phase != IDLE || (running & one(r)))) safe = false;
        }
        if (safe) now.confirmed |= one(c);
    }

    // Signals and grants.
    for (int r = 0; r < plan.routes; r++)
        proceed[r] = now.route[r].phase == SET && all_points_sound(r) && clear_and_unblocked(r) && out_allowed(r);
    find_grants();

    printf("{\"output\":{\"routes\":{");
    first = true;
    for (int r = 0; r < plan.routes; r++)
        if (now.route[r].phase != IDLE) {
            put_name(&first, plan.route[r].name);
            printf(":\"%s\"", phases[now.route[r].phase]);
        }
    printf("},\"proceed\":[");
    first = true;
    for (int r = 0; r < plan.routes; r++)
        if (proceed[r]) put_name(&first, plan.route[r].name);
    printf("],\"drives\":{");
    first = true;
    for (int p = 0; p < plan.points; p++)
        if (now.drives[p]) {
            put_name(&first, plan.point[p]);
            printf(":\"%s\"", now.drives[p] == NORMAL ? "normal" : "reverse");
        }
    set silent = 0;
    for (int s = 0; s < plan.segments; s++)
        for (int i = plan.segment[s].length - plan.segment[s].shared; i < plan.segment[s].length && (now.travel[s] != TOWARD || FAULTY(33)); i++)
            if (i >= 0) silent |= one(plan.segment[s].circuit[i]);
    printf("},\"telegrams\":{");
    first = true;
    for (int c = 0; c < plan.circuits; c++)
        if (!(silent & one(c))) telegram(&first, c, all);
    printf("},\"permits\":[");
    first = true;
    for (int s = 0; s < plan.segments; s++)
        if (now.travel[s] == TOWARD && !line_blocked(s)) put_name(&first, plan.segment[s].name);
    printf("],\"confirmed\":[");
    first = true;
    for (int c = 0; c < plan.circuits; c++)
        if (now.confirmed & one(c)) put_name(&first, plan.circuit[c]);
    printf("]");
    if (silent) {
        printf(",\"silent\":[");
        first = true;
        for (int c = 0; c < plan.circuits; c++)
            if (silent & one(c)) put_name(&first, plan.circuit[c]);
        printf("]");
    }
    if (!what) printf(",\"answer\":null}}\n");
    else if (refused) printf(",\"answer\":{\"refused\":\"%s\"}}}\n", refused);
    else printf(",\"answer\":\"accepted\"}}\n");
    return true;
}

int main(int count, char **arguments) {
    static const struct machine machine = {"interlocking", start, step};
    return json_serve(&machine, count, arguments);
}
