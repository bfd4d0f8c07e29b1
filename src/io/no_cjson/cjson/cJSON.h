// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands for cJSON's header in a library without it: a tree that nobody can make, so that its readers are compiled and never
// reached (no_json_text.c).
#ifndef EWA_SRC_IO_NO_CJSON_H
#define EWA_SRC_IO_NO_CJSON_H

#include <stddef.h>

typedef int cJSON_bool;
typedef struct cJSON {
    struct cJSON *next, *child;
    char *valuestring, *string;
    double valuedouble;
} cJSON;

#define cJSON_ArrayForEach(item, array)                                                                                \
    for ((item) = (array) ? (array)->child : NULL; (item); (item) = (item)->next)

#define IS(name)                                                                                                       \
    static inline cJSON_bool name(const cJSON *item) {                                                                 \
        (void)item;                                                                                                    \
        return 0;                                                                                                      \
    }
IS(cJSON_IsNumber)
IS(cJSON_IsArray)
IS(cJSON_IsString)
IS(cJSON_IsObject)
IS(cJSON_IsTrue)
IS(cJSON_IsBool)
#undef IS

static inline cJSON *cJSON_GetObjectItemCaseSensitive(const cJSON *object, const char *name) {
    return (void)object, (void)name, NULL;
}
static inline cJSON *cJSON_GetArrayItem(const cJSON *array, int index) { return (void)array, (void)index, NULL; }
static inline int cJSON_GetArraySize(const cJSON *array) { return (void)array, 0; }
static inline char *cJSON_GetStringValue(const cJSON *item) { return (void)item, NULL; }
static inline cJSON *cJSON_CreateObject(void) { return NULL; }
static inline cJSON *cJSON_CreateArray(void) { return NULL; }
static inline cJSON *cJSON_CreateRaw(const char *raw) { return (void)raw, NULL; }
static inline cJSON *cJSON_CreateString(const char *text) { return (void)text, NULL; }
static inline cJSON_bool cJSON_AddItemToArray(cJSON *array, cJSON *item) { return (void)array, (void)item, 0; }
static inline cJSON_bool cJSON_AddItemToObject(cJSON *object, const char *name, cJSON *item) {
    return (void)object, (void)name, (void)item, 0;
}
static inline cJSON *cJSON_AddStringToObject(cJSON *object, const char *name, const char *text) {
    return (void)object, (void)name, (void)text, NULL;
}
static inline cJSON *cJSON_AddRawToObject(cJSON *object, const char *name, const char *raw) {
    return (void)object, (void)name, (void)raw, NULL;
}
static inline cJSON *cJSON_AddArrayToObject(cJSON *object, const char *name) { return (void)object, (void)name, NULL; }
static inline cJSON *cJSON_AddNumberToObject(cJSON *object, const char *name, double number) {
    return (void)object, (void)name, (void)number, NULL;
}
static inline cJSON *cJSON_AddBoolToObject(cJSON *object, const char *name, cJSON_bool value) {
    return (void)object, (void)name, (void)value, NULL;
}
static inline char *cJSON_Print(const cJSON *item) { return (void)item, NULL; }
static inline void cJSON_Delete(cJSON *item) { (void)item; }
static inline void cJSON_free(void *memory) { (void)memory; }

#endif
