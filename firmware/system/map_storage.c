#include "system/map_storage.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "exchange/wake.h"
#include "store/map_file.h"
#include "system/background.h"

#define LOOK_NS 1000000000
enum { FOLDER_RIGHTS = 0755, PATH_BYTES = ALE_CONFIG_PATH + ALE_COMMAND_ARG_BYTES + 8 };

/* Whose turn it is; that side alone touches the job. */
typedef enum { IDLE, ORDERED, DONE } turn_t;

struct ale_map_keeper {
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
static void save(ale_map_keeper_t *keeper, const char *path)
{
    char error[ALE_MAP_FILE_ERROR];
    ale_map_outcome_t *outcome = &keeper->outcome;
    mkdir(keeper->config->map_folder, FOLDER_RIGHTS);
    outcome->fine = ale_map_file_save(path, &keeper->map, error) == 0;
    if (outcome->fine) {
        snprintf(outcome->text, sizeof outcome->text, "saved %.60s: %u lines, %u corners", keeper->name,
                 keeper->map.line_count, keeper->map.corner_count);
    } else {
        snprintf(outcome->text, sizeof outcome->text, "not saved: %.140s", error);
    }
}

static void load(ale_map_keeper_t *keeper, const char *path)
{
    char error[ALE_MAP_FILE_ERROR];
    ale_map_outcome_t *outcome = &keeper->outcome;
    outcome->fine = ale_map_file_load(path, &keeper->map, error) == 0;
    if (outcome->fine) {
        ale_exchange_load(keeper->exchange, &keeper->map);
        snprintf(outcome->text, sizeof outcome->text, "loaded %.60s: %u lines, %u corners", keeper->name,
                 keeper->map.line_count, keeper->map.corner_count);
    } else {
        snprintf(outcome->text, sizeof outcome->text, "not loaded: %.140s", error);
    }
}

static void work(ale_map_keeper_t *keeper)
{
    if (atomic_load_explicit(&keeper->turn, memory_order_acquire) != ORDERED) {
        return;
    }
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s/%s.map", keeper->config->map_folder, keeper->name);
    keeper->outcome = (ale_map_outcome_t){.loaded = keeper->load};
    if (keeper->load) {
        load(keeper, path);
    } else {
        save(keeper, path);
    }
    atomic_store_explicit(&keeper->turn, DONE, memory_order_release);
    ale_wake_post(keeper->exchange->under_way);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_map_keeper_t *keeper = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&keeper->thread, LOOK_NS);
        work(keeper);
    }
    work(keeper);
}

ale_map_keeper_t *ale_map_keeper_start(const ale_config_t *config, ale_exchange_t *exchange)
{
    ale_map_keeper_t *keeper = calloc(1, sizeof *keeper);
    if (!keeper) {
        return NULL;
    }
    keeper->config = config;
    keeper->exchange = exchange;
    atomic_init(&keeper->turn, IDLE);
    if (ale_background_start(&keeper->thread, "ale-maps", run, keeper, 0) < 0) {
        ale_map_keeper_stop(keeper);
        return NULL;
    }
    return keeper;
}

void ale_map_keeper_stop(ale_map_keeper_t *keeper)
{
    if (!keeper) {
        return;
    }
    ale_background_stop(&keeper->thread);
    free(keeper);
}

static bool order(ale_map_keeper_t *keeper, const char *name, const ale_map_t *map)
{
    if (atomic_load_explicit(&keeper->turn, memory_order_acquire) != IDLE) {
        return false;
    }
    keeper->load = map == NULL;
    snprintf(keeper->name, sizeof keeper->name, "%s", name);
    if (map) {
        keeper->map = *map;
    }
    atomic_store_explicit(&keeper->turn, ORDERED, memory_order_release);
    ale_background_wake(&keeper->thread);
    return true;
}

bool ale_map_keeper_save(ale_map_keeper_t *keeper, const char *name, const ale_map_t *map)
{
    return order(keeper, name, map);
}

bool ale_map_keeper_load(ale_map_keeper_t *keeper, const char *name)
{
    return order(keeper, name, NULL);
}

bool ale_map_keeper_done(ale_map_keeper_t *keeper, ale_map_outcome_t *outcome)
{
    if (atomic_load_explicit(&keeper->turn, memory_order_acquire) != DONE) {
        return false;
    }
    *outcome = keeper->outcome;
    atomic_store_explicit(&keeper->turn, IDLE, memory_order_release);
    return true;
}
