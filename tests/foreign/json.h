// A reader of JSON lines, for the implementations beside it: C11, no allocation, no dependency.
// A line is read into one buffer, its values into one array; strings are decoded in place. Numbers keep their text, so
// that 44.9 is read exactly.
#ifndef FOREIGN_JSON_H
#define FOREIGN_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The fault that is seeded on purpose: 0 is none. `--fault 3` or `-DFAULT=3` seeds the third.
#ifndef FAULT
#define FAULT 0
#endif
static int seeded = FAULT;
#define FAULTY(n) (seeded == (n))

enum kind { J_NULL, J_FALSE, J_TRUE, J_NUMBER, J_STRING, J_ARRAY, J_OBJECT };

struct json {
    enum kind kind;
    char *key;    // in an object: the field's name
    char *text;   // of a string: decoded; of a number: as it was written
    int size;     // of a string or number: bytes; of an array or object: values
    int first;    // of an array or object: the place of its first value, or -1
    int next;     // the place of the next value of the same array or object, or -1
};

enum { JSON_LINE = 1 << 20, JSON_VALUES = 1 << 15, JSON_DEPTH = 32 };

static char json_line[JSON_LINE + 1];
static struct json json_values[JSON_VALUES];
static int json_used;
static char *json_at;

static inline void json_space(void) {
    while (*json_at == ' ' || *json_at == '\t' || *json_at == '\r' || *json_at == '\n') json_at++;
}

static inline int json_hex(const char *from) {
    int code = 0;
    for (int i = 0; i < 4; i++) {
        char c = from[i];
        int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
        if (digit < 0) return -1;
        code = code * 16 + digit;
    }
    return code;
}

// Decodes the string that begins here into the place where it stands: it never grows.
static inline char *json_string(int *size) {
    if (*json_at != '"') return NULL;
    char *start = ++json_at, *to = start;
    for (;;) {
        unsigned char c = (unsigned char)*json_at;
        if (c < 0x20) return NULL;
        json_at++;
        if (c == '"') break;
        if (c != '\\') {
            *to++ = (char)c;
            continue;
        }
        switch (*json_at++) {
        case '"': *to++ = '"'; break;
        case '\\': *to++ = '\\'; break;
        case '/': *to++ = '/'; break;
        case 'b': *to++ = '\b'; break;
        case 'f': *to++ = '\f'; break;
        case 'n': *to++ = '\n'; break;
        case 'r': *to++ = '\r'; break;
        case 't': *to++ = '\t'; break;
        case 'u': {
            int code = json_hex(json_at);
            if (code <= 0) return NULL; // a zero byte would end the string early
            json_at += 4;
            if (code >= 0xd800 && code < 0xdc00) {
                if (json_at[0] != '\\' || json_at[1] != 'u') return NULL;
                int low = json_hex(json_at + 2);
                if (low < 0xdc00 || low > 0xdfff) return NULL;
                json_at += 6;
                code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
            } else if (code >= 0xdc00 && code < 0xe000) {
                return NULL;
            }
            if (code < 0x80) {
                *to++ = (char)code;
            } else if (code < 0x800) {
                *to++ = (char)(0xc0 | code >> 6);
                *to++ = (char)(0x80 | (code & 0x3f));
            } else if (code < 0x10000) {
                *to++ = (char)(0xe0 | code >> 12);
                *to++ = (char)(0x80 | (code >> 6 & 0x3f));
                *to++ = (char)(0x80 | (code & 0x3f));
            } else {
                *to++ = (char)(0xf0 | code >> 18);
                *to++ = (char)(0x80 | (code >> 12 & 0x3f));
                *to++ = (char)(0x80 | (code >> 6 & 0x3f));
                *to++ = (char)(0x80 | (code & 0x3f));
            }
            break;
        }
        default: return NULL;
        }
    }
    *to = '\0';
    *size = (int)(to - start);
    return start;
}

static inline bool json_digits(void) {
    if (*json_at < '0' || *json_at > '9') return false;
    while (*json_at >= '0' && *json_at <= '9') json_at++;
    return true;
}

static inline int json_value(int depth) {
    if (json_used == JSON_VALUES || depth > JSON_DEPTH) return -1;
    int place = json_used++;
    struct json *value = &json_values[place];
    memset(value, 0, sizeof *value);
    value->first = value->next = -1;
    json_space();
    char c = *json_at;
    if (c == '{' || c == '[') {
        value->kind = c == '{' ? J_OBJECT : J_ARRAY;
        char end = c == '{' ? '}' : ']';
        json_at++;
        json_space();
        if (*json_at == end) {
            json_at++;
            return place;
        }
        int last = -1;
        for (;;) {
            char *key = NULL;
            if (value->kind == J_OBJECT) {
                int size;
                json_space();
                key = json_string(&size);
                json_space();
                if (!key || *json_at++ != ':') return -1;
            }
            int item = json_value(depth + 1);
            if (item < 0) return -1;
            json_values[item].key = key;
            if (last < 0) value->first = item;
            else json_values[last].next = item;
            last = item;
            value->size++;
            json_space();
            char after = *json_at++;
            if (after == end) return place;
            if (after != ',') return -1;
        }
    }
    if (c == '"') {
        value->kind = J_STRING;
        value->text = json_string(&value->size);
        return value->text ? place : -1;
    }
    if (c == '-' || (c >= '0' && c <= '9')) {
        value->kind = J_NUMBER;
        value->text = json_at;
        if (*json_at == '-') json_at++;
        if (*json_at == '0') json_at++;
        else if (!json_digits()) return -1;
        if (*json_at == '.' && (json_at++, !json_digits())) return -1;
        if (*json_at == 'e' || *json_at == 'E') {
            json_at++;
            if (*json_at == '+' || *json_at == '-') json_at++;
            if (!json_digits()) return -1;
        }
        value->size = (int)(json_at - value->text);
        return place;
    }
    static const struct { const char *word; enum kind kind; } words[] = {{"null", J_NULL}, {"false", J_FALSE}, {"true", J_TRUE}};
    for (int i = 0; i < 3; i++) {
        size_t size = strlen(words[i].word);
        if (strncmp(json_at, words[i].word, size) == 0) {
            value->kind = words[i].kind;
            json_at += size;
            return place;
        }
    }
    return -1;
}

// Reads the next line of standard input. False at its end; `*value` is NULL where the line is no JSON.
static inline bool json_read(struct json **value) {
    int size = 0, c;
    bool fits = true;
    while ((c = getchar()) != EOF && c != '\n') {
        if (c == '\0' || size == JSON_LINE) fits = false;
        else json_line[size++] = (char)c;
    }
    if (c == EOF && size == 0) return false;
    json_line[size] = '\0';
    json_at = json_line;
    json_used = 0;
    *value = NULL;
    if (!fits) return true;
    int place = json_value(0);
    if (place < 0) return true;
    json_space();
    if (*json_at == '\0') *value = &json_values[place];
    return true;
}

static inline struct json *json_first(const struct json *value) {
    return value->first < 0 ? NULL : &json_values[value->first];
}

static inline struct json *json_next(const struct json *value) {
    return value->next < 0 ? NULL : &json_values[value->next];
}

static inline struct json *json_field(const struct json *object, const char *name) {
    for (struct json *item = json_first(object); item; item = json_next(item))
        if (strcmp(item->key, name) == 0) return item;
    return NULL;
}

// Whether this is an object that has no fields but these, each at most once. `names` ends with NULL.
static inline bool json_only(const struct json *object, const char *const *names) {
    if (!object || object->kind != J_OBJECT) return false;
    for (struct json *item = json_first(object); item; item = json_next(item)) {
        bool known = false;
        for (int i = 0; names[i]; i++) known = known || strcmp(item->key, names[i]) == 0;
        if (!known || json_field(object, item->key) != item) return false;
    }
    return true;
}

// Reads a number times ten to the power `digits` where that is a whole number from 0 to `most`.
static inline bool json_scaled(const struct json *value, int digits, int64_t most, int64_t *out) {
    if (!value || value->kind != J_NUMBER) return false;
    const char *at = value->text, *end = value->text + value->size;
    bool negative = *at == '-', point = false, exponent_negative = false;
    int64_t whole = 0, exponent = digits;
    int zeros = 0;
    if (negative) at++;
    for (; at < end && *at != 'e' && *at != 'E'; at++) {
        if (*at == '.') {
            point = true;
            continue;
        }
        if (point) exponent--;
        // Zeros at the end are not multiplied in: 10.0 is 10, however many there are.
        if (*at == '0') {
            zeros++;
            continue;
        }
        for (; zeros > 0; zeros--) {
            if (whole > INT64_MAX / 100) return false;
            whole *= 10;
        }
        if (whole > INT64_MAX / 100) return false;
        whole = whole * 10 + (*at - '0');
    }
    exponent += zeros;
    if (at < end) {
        at++;
        if (*at == '-' || *at == '+') exponent_negative = *at++ == '-';
        int64_t written = 0;
        for (; at < end; at++) written = written > 100000 ? written : written * 10 + (*at - '0');
        exponent += exponent_negative ? -written : written;
    }
    if (whole == 0) exponent = 0;
    for (; exponent > 0; exponent--) {
        if (whole > most) return false;
        whole *= 10;
    }
    for (; exponent < 0; exponent++) {
        if (whole % 10 != 0) return false;
        whole /= 10;
    }
    if ((negative && whole != 0) || whole > most) return false;
    *out = whole;
    return true;
}

static inline bool json_whole(const struct json *value, int64_t most, int64_t *out) {
    return json_scaled(value, 0, most, out);
}

static inline bool json_bool(const struct json *value, bool *out) {
    if (!value || (value->kind != J_TRUE && value->kind != J_FALSE)) return false;
    *out = value->kind == J_TRUE;
    return true;
}

static inline void json_malformed(const char *reason) {
    printf("{\"malformed\":{\"reason\":\"%s\"}}\n", reason);
}

static inline void json_rejected(const char *reason) {
    printf("{\"rejected\":{\"reason\":\"%s\"}}\n", reason);
}

// What a machine does: each writes one reply line.
struct machine {
    const char *name;
    bool (*start)(const struct json *config); // replies; whether the machine is started
    bool (*step)(const struct json *step);    // replies; false and no reply where the step is malformed
};

// Protocol 1: one reply to each line.
static inline int json_serve(const struct machine *machine, int count, char **arguments) {
    if (count == 3 && strcmp(arguments[1], "--fault") == 0) {
        seeded = atoi(arguments[2]);
    } else if (count != 1) {
        fprintf(stderr, "usage: %s [--fault NUMBER]\n", arguments[0]);
        return 2;
    }
    static const char *const start_fields[] = {"protocol", "machine", "config", NULL};
    static const char *const none[] = {NULL};
    struct json *line;
    bool started = false;
    unsigned long long steps = 0;
    while (json_read(&line)) {
        struct json *body = line && line->kind == J_OBJECT && line->size == 1 ? json_first(line) : NULL;
        if (!body) {
            json_malformed("a line is one JSON object with one field: start, step or stop");
        } else if (strcmp(body->key, "step") == 0) {
            if (!started) json_malformed("no case is open: start one first");
            else if (body->kind == J_OBJECT && machine->step(body)) steps++;
            else json_malformed("the step is not one of this machine");
        } else if (strcmp(body->key, "stop") == 0) {
            if (!started || !json_only(body, none)) {
                json_malformed("a stop has no field, and ends the case that is open");
            } else {
                printf("{\"stopped\":{\"steps\":%llu}}\n", steps);
                started = false;
            }
        } else if (strcmp(body->key, "start") == 0) {
            int64_t protocol = 0;
            struct json *name = json_only(body, start_fields) ? json_field(body, "machine") : NULL;
            if (started) {
                json_malformed("a case is open: stop it first");
            } else if (!name || name->kind != J_STRING || !json_whole(json_field(body, "protocol"), UINT32_MAX, &protocol)) {
                json_malformed("a start has protocol, machine and config");
            } else if (protocol != 1) {
                json_rejected("the protocol is 1");
            } else if (strcmp(name->text, machine->name) != 0) {
                json_rejected("this implementation has another machine");
            } else {
                started = machine->start(json_field(body, "config"));
                steps = 0;
            }
        } else {
            json_malformed("a line is a start, a step or a stop");
        }
        fflush(stdout);
    }
    return 0;
}

#endif
