#include "mapping/map_storage.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "exchange/wake.h"
#include "store/map_file.h"
#include "system/background.h"

#define LOOK_NS 1000000000
enum { FOLDER_RIGHTS = 0750, PATH_BYTES = ALE_CONFIG_PATH + ALE_COMMAND_ARG_BYTES + 8 };

/* Whose turn it is; that side alone touches the job. */
typedef enum { IDLE, ORDERED, DONE } turn_t;

struct ale_map_storage {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_background_t thread;
    atomic_int turn;
    bool load;
    char name[ALE_COMMAND_ARG_BYTES];
    ale_map_t map;
    ale_map_outcome_t outcome;
};

/* The file's name as people call it is enough where all lies in one folder; errors name the whole path. */
static void save(ale_map_storage_t *storage, const char *path)
{
    char error[ALE_MAP_FILE_ERROR];
    ale_map_outcome_t *outcome = &storage->outcome;
    mkdir(storage->config->map_folder, FOLDER_RIGHTS);
    outcome->fine = ale_map_file_save(path, &storage->map, error) == 0;
    if (outcome->fine) {
        snprintf(outcome->text, sizeof outcome->text, "saved %.60s: %u lines, %u corners", storage->name,
                 storage->map.line_count, storage->map.corner_count);
    } else {
        snprintf(outcome->text, sizeof outcome->text, "not saved: %.140s", error);
    }
}

static void load(ale_map_storage_t *storage, const char *path)
{
    char error[ALE_MAP_FILE_ERROR];
    ale_map_outcome_t *outcome = &storage->outcome;
    outcome->fine = ale_map_file_load(path, &storage->map, error) == 0;
    if (outcome->fine) {
        ale_exchange_load(storage->exchange, &storage->map);
        snprintf(outcome->text, sizeof outcome->text, "loaded %.60s: %u lines, %u corners", storage->name,
                 storage->map.line_count, storage->map.corner_count);
    } else {
        snprintf(outcome->text, sizeof outcome->text, "not loaded: %.140s", error);
    }
}

static void work(ale_map_storage_t *storage)
{
    if (atomic_load_explicit(&storage->turn, memory_order_acquire) != ORDERED) {
        return;
    }
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s/%s.map", storage->config->map_folder, storage->name);
    storage->outcome = (ale_map_outcome_t){.loaded = storage->load};
    if (storage->load) {
        load(storage, path);
    } else {
        save(storage, path);
    }
    atomic_store_explicit(&storage->turn, DONE, memory_order_release);
    ale_wake_post(storage->exchange->under_way);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_map_storage_t *storage = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&storage->thread, LOOK_NS);
        work(storage);
    }
    work(storage);
}

ale_map_storage_t *ale_map_storage_start(const ale_config_t *config, ale_exchange_t *exchange)
{
    ale_map_storage_t *storage = calloc(1, sizeof *storage);
    if (!storage) {
        return NULL;
    }
    storage->config = config;
    storage->exchange = exchange;
    atomic_init(&storage->turn, IDLE);
    if (ale_background_start(&storage->thread, "ale-maps", run, storage, 0) < 0) {
        ale_map_storage_stop(storage);
        return NULL;
    }
    return storage;
}

void ale_map_storage_stop(ale_map_storage_t *storage)
{
    if (!storage) {
        return;
    }
    ale_background_stop(&storage->thread);
    free(storage);
}

static bool order(ale_map_storage_t *storage, const char *name, const ale_map_t *map)
{
    if (atomic_load_explicit(&storage->turn, memory_order_acquire) != IDLE) {
        return false;
    }
    storage->load = map == NULL;
    snprintf(storage->name, sizeof storage->name, "%s", name);
    if (map) {
        storage->map = *map;
    }
    atomic_store_explicit(&storage->turn, ORDERED, memory_order_release);
    ale_background_wake(&storage->thread);
    return true;
}

bool ale_map_storage_save(ale_map_storage_t *storage, const char *name, const ale_map_t *map)
{
    return order(storage, name, map);
}

bool ale_map_storage_load(ale_map_storage_t *storage, const char *name)
{
    return order(storage, name, NULL);
}

bool ale_map_storage_done(ale_map_storage_t *storage, ale_map_outcome_t *outcome)
{
    if (atomic_load_explicit(&storage->turn, memory_order_acquire) != DONE) {
        return false;
    }
    *outcome = storage->outcome;
    atomic_store_explicit(&storage->turn, IDLE, memory_order_release);
    return true;
}
