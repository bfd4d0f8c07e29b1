// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Requests by libcurl, which is loaded when the first is made: linked, it and its thirty libraries would make every start of a
// program twice as long.
#include "io/http_answer.h"
#include "base/platform.h"

#include <curl/curl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum {
    AT_ONCE = 6,  // connections, as browsers have them
    ATTEMPTS = 4, // at one byte
    CONNECT_MS = 10000,
    SILENCE_S = 20, // without a byte
    POLL_MS = 50,   // between two looks at the progress callback
    REDIRECTS = 5,
};

static const double FIRST_PAUSE_S = 0.2, PAUSE_GROWTH = 3;

/// What is called of the library.
typedef struct curl_functions {
    CURLcode (*global_init)(long flags);
    CURL *(*easy_init)(void);
    CURLcode (*easy_setopt)(CURL *handle, CURLoption option, ...);
    void (*easy_reset)(CURL *handle);
    void (*easy_cleanup)(CURL *handle);
    CURLM *(*multi_init)(void);
    CURLMcode (*multi_add_handle)(CURLM *multi, CURL *handle);
    CURLMcode (*multi_remove_handle)(CURLM *multi, CURL *handle);
    CURLMcode (*multi_perform)(CURLM *multi, int *running_count);
    CURLMcode (*multi_poll)(CURLM *multi, struct curl_waitfd *extra, unsigned extra_count, int timeout_ms, int *event_count);
    CURLMsg *(*multi_info_read)(CURLM *multi, int *left_count);
    CURLMcode (*multi_cleanup)(CURLM *multi);
    const char *(*easy_strerror)(CURLcode code);
} curl_functions;

typedef struct function_row {
    const char *name;
    size_t at_bytes;
} function_row;

static const function_row function_rows[] = {
    {"curl_global_init", offsetof(curl_functions, global_init)},
    {"curl_easy_init", offsetof(curl_functions, easy_init)},
    {"curl_easy_setopt", offsetof(curl_functions, easy_setopt)},
    {"curl_easy_reset", offsetof(curl_functions, easy_reset)},
    {"curl_easy_cleanup", offsetof(curl_functions, easy_cleanup)},
    {"curl_multi_init", offsetof(curl_functions, multi_init)},
    {"curl_multi_add_handle", offsetof(curl_functions, multi_add_handle)},
    {"curl_multi_remove_handle", offsetof(curl_functions, multi_remove_handle)},
    {"curl_multi_perform", offsetof(curl_functions, multi_perform)},
    {"curl_multi_poll", offsetof(curl_functions, multi_poll)},
    {"curl_multi_info_read", offsetof(curl_functions, multi_info_read)},
    {"curl_multi_cleanup", offsetof(curl_functions, multi_cleanup)},
    {"curl_easy_strerror", offsetof(curl_functions, easy_strerror)},
};

/// A part that is being asked for.
typedef struct request {
    ewa_http *transfer;
    ewa_http_part *part; // NULL: none
    CURL *handle;
    uint32_t attempt_count; ///< since a byte came
    double not_before_s;    ///< of the next attempt
    bool running, done;
    ewa_http_answer answer;
    char error[CURL_ERROR_SIZE];
} request;

struct ewa_http {
    ewa_context *context;
    void *library;
    curl_functions curl;
    CURLM *multi;
    request requests[AT_ONCE];
};

// ---- The library

static bool load_functions(ewa_http *t) {
    static const char *const names[] = {"libcurl.so.4", "libcurl-gnutls.so.4", "libcurl.4.dylib", "libcurl-x64.dll", "libcurl.dll"};
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !t->library; i++) t->library = ewa_platform_open_library(names[i]);
    for (size_t i = 0; i < sizeof function_rows / sizeof function_rows[0]; i++) {
        void *found = t->library ? ewa_platform_find_function(t->library, function_rows[i].name) : NULL;
        if (!found) return false;
        memcpy((uint8_t *)&t->curl + function_rows[i].at_bytes, &found, sizeof found);
    }
    return true;
}

ewa_status ewa_http_create(ewa_context *context, ewa_http **transfer) {
    *transfer = NULL;
    ewa_http *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    ewa_status status = EWA_OK;
    if (!load_functions(made))
        status = ewa_fail(context, EWA_ERROR_UNSUPPORTED, "files on servers are read by libcurl (libcurl.so.4), which is not there");
    if (status == EWA_OK) {
        made->multi = made->curl.global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK ? made->curl.multi_init() : NULL;
        if (!made->multi) status = EWA_ERROR_MEMORY;
    }
    for (int i = 0; i < AT_ONCE && status == EWA_OK; i++) {
        made->requests[i].handle = made->curl.easy_init();
        if (!made->requests[i].handle) status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK)
        *transfer = made;
    else
        ewa_http_destroy(&made);
    return status;
}

void ewa_http_destroy(ewa_http **transfer) {
    ewa_http *old = *transfer;
    if (!old) return;
    for (int i = 0; i < AT_ONCE; i++)
        if (old->requests[i].handle) old->curl.easy_cleanup(old->requests[i].handle);
    if (old->multi) old->curl.multi_cleanup(old->multi);
    // The library stays loaded: what it has registered for the end of the process is in it.
    ewa_release(old->context, old, 1, sizeof *old);
    *transfer = NULL;
}

// ---- What servers say

static size_t take_header(char *line, size_t one, size_t length, void *user) {
    (void)one;
    ewa_http_answer_take_header(user, line, length);
    return length;
}

static size_t take_body(char *bytes, size_t one, size_t size_bytes, void *user) {
    (void)one;
    // Less than all ends the answer.
    return ewa_http_answer_take_body(user, bytes, size_bytes) ? size_bytes : 0;
}

// ---- Requests

/// Begins to ask for what is missing of a part.
static bool start(request *r, const char *address) {
    const curl_functions *curl = &r->transfer->curl;
    CURL *h = r->handle;
    char range[64], agent[64];
    const uint64_t from = r->part->at_bytes + r->part->got_bytes;
    snprintf(range, sizeof range, "%" PRIu64 "-%" PRIu64, from, r->part->at_bytes + r->part->size_bytes - 1);
    snprintf(agent, sizeof agent, "ewa/%s", ewa_version());
    ewa_http_answer_begin(&r->answer);
    r->error[0] = 0;
    r->attempt_count++;
    const bool safe = strncasecmp(address, "https:", 6) == 0;
    curl->easy_reset(h);
    const bool set = curl->easy_setopt(h, CURLOPT_URL, address) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_PROTOCOLS_STR, "http,https") == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_REDIR_PROTOCOLS_STR, safe ? "https" : "http,https") == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_FOLLOWLOCATION, 1L) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_MAXREDIRS, (long)REDIRECTS) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_RANGE, range) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_NOSIGNAL, 1L) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_CONNECTTIMEOUT_MS, (long)CONNECT_MS) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_LOW_SPEED_LIMIT, 1L) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_LOW_SPEED_TIME, (long)SILENCE_S) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_USERAGENT, agent) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_ERRORBUFFER, r->error) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_HEADERFUNCTION, take_header) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_HEADERDATA, &r->answer) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_WRITEFUNCTION, take_body) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_WRITEDATA, &r->answer) == CURLE_OK &&
                     curl->easy_setopt(h, CURLOPT_PRIVATE, r) == CURLE_OK &&
                     curl->multi_add_handle(r->transfer->multi, h) == CURLM_OK;
    r->running = set;
    return set;
}

static void end_request(request *r, ewa_status status, const char *reason) {
    r->part->status = status;
    snprintf(r->part->reason, sizeof r->part->reason, "%s", reason);
    ewa_http_answer_end(&r->answer);
    r->done = true;
}

/// Why a transfer ended that did not come to an answer; whether it may go better another time.
static const char *explain(const request *r, CURLcode code, bool *again) {
    *again = false;
    switch (code) {
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_COULDNT_RESOLVE_PROXY:
        return "the name of the server is not known";
    case CURLE_TOO_MANY_REDIRECTS:
        return "it leads on more than 5 times";
    case CURLE_UNSUPPORTED_PROTOCOL:
        return "it leads to an address that is neither http nor https, or from https to http";
    case CURLE_URL_MALFORMAT:
        return "this is no address";
    case CURLE_COULDNT_CONNECT:
        *again = true;
        return "the server cannot be reached";
    case CURLE_OPERATION_TIMEDOUT:
        *again = true;
        return "the server is silent";
    case CURLE_PARTIAL_FILE:
    case CURLE_RECV_ERROR:
    case CURLE_SEND_ERROR:
    case CURLE_GOT_NOTHING:
    case CURLE_HTTP2:
    case CURLE_HTTP2_STREAM:
        *again = true;
        return "the connection was cut";
    default:
        return r->error[0] ? r->error : r->transfer->curl.easy_strerror(code);
    }
}

/// What became of an answer.
static void settle(request *r, CURLcode code) {
    const ewa_http_answer *answer = &r->answer;
    bool again;
    char said[64];
    r->running = false;
    // Bytes came: what is wrong is not as it was.
    if (answer->part->got_bytes > answer->before_bytes) r->attempt_count = 0;
    if (answer->refused) {
        end_request(r, answer->refused_status, answer->refused);
        return;
    }
    if (code == CURLE_OK && ewa_http_answer_is_whole(answer)) {
        end_request(r, EWA_OK, "");
        return;
    }
    const char *reason = code == CURLE_OK ? NULL : explain(r, code, &again);
    if (code == CURLE_OK && answer->code == 206) {
        again = true;
        reason = "the connection was cut";
    } else if (code == CURLE_OK) {
        again = answer->code == 429 || answer->code >= 500;
        snprintf(said, sizeof said,
                 answer->code == 404 || answer->code == 410   ? "the server has no such file (%ld)"
                 : answer->code == 401 || answer->code == 403 ? "the server refuses it (%ld)"
                 : again                                      ? "the server fails (%ld)"
                                                              : "the server answers %ld",
                 answer->code);
        reason = said;
    }
    if (!again || r->attempt_count >= ATTEMPTS) {
        char tried[EWA_HTTP_REASON_BYTES];
        snprintf(tried, sizeof tried, "%.200s%s", reason, again ? ", four times" : "");
        end_request(r, EWA_ERROR_IO, tried);
        return;
    }
    double pause_s = FIRST_PAUSE_S;
    for (uint32_t i = 1; i < r->attempt_count; i++) pause_s *= PAUSE_GROWTH;
    r->not_before_s = ewa_now_s() + pause_s;
}

/// Takes the next part that is wanted, of what is left, into a request that has none.
static bool give_work(ewa_http *t, request *r, ewa_http_part *parts, uint32_t count, uint32_t *next) {
    if (*next == count) return false;
    CURL *handle = r->handle;
    *r = (request){.transfer = t, .part = &parts[(*next)++], .handle = handle};
    ewa_http_answer_open(t->context, r->part, &r->answer);
    return true;
}

/// Hears what has ended.
static void hear(ewa_http *t) {
    int left;
    for (CURLMsg *message = t->curl.multi_info_read(t->multi, &left); message; message = t->curl.multi_info_read(t->multi, &left)) {
        if (message->msg != CURLMSG_DONE) continue;
        const CURLcode code = message->data.result;
        for (int i = 0; i < AT_ONCE; i++)
            if (t->requests[i].handle == message->easy_handle) {
                t->curl.multi_remove_handle(t->multi, t->requests[i].handle);
                settle(&t->requests[i], code);
                break;
            }
    }
}

void ewa_http_read(ewa_http *transfer, const char *address, ewa_http_part *parts, uint32_t count) {
    uint32_t next = 0, done_count = 0;
    ewa_status ended = EWA_OK;
    bool failed = false;
    for (int i = 0; i < AT_ONCE; i++) transfer->requests[i].part = NULL;
    while (done_count < count && ended == EWA_OK && !failed) {
        int running;
        for (int i = 0; i < AT_ONCE; i++) {
            request *r = &transfer->requests[i];
            if (r->part && r->done) {
                done_count++;
                failed = failed || r->part->status != EWA_OK;
                r->part = NULL;
            }
            if (!r->part && !failed) give_work(transfer, r, parts, count, &next);
            if (r->part && !r->running && !r->done && ewa_now_s() >= r->not_before_s && !start(r, address))
                end_request(r, EWA_ERROR_IO, "libcurl is too old, or has no memory");
        }
        if (transfer->curl.multi_perform(transfer->multi, &running) != CURLM_OK) ended = EWA_ERROR_MEMORY;
        hear(transfer);
        bool waits = done_count < count && !failed;
        for (int i = 0; i < AT_ONCE; i++) waits = waits && !(transfer->requests[i].part && transfer->requests[i].done);
        if (waits) transfer->curl.multi_poll(transfer->multi, NULL, 0, POLL_MS, NULL);
        if (ended == EWA_OK) ended = ewa_progress(transfer->context, "read", count ? (double)done_count / count : 1);
    }
    // What was not waited for.
    for (int i = 0; i < AT_ONCE; i++) {
        request *r = &transfer->requests[i];
        if (r->part && r->running) transfer->curl.multi_remove_handle(transfer->multi, r->handle), r->running = false;
        if (r->part && !r->done) end_request(r, ended != EWA_OK ? ended : EWA_CANCELLED, "it was given up");
        r->part = NULL;
    }
    for (; next < count; next++) parts[next].status = ended != EWA_OK ? ended : EWA_CANCELLED, parts[next].whole = NULL;
}
