#include "store/map_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file/bytes.h"
#include "file/whole_file.h"
#include "store/map_text.h"

enum { RIGHTS = 0640 };

static int fail(char error[ALE_MAP_FILE_ERROR], const char *path, const char *reason)
{
    snprintf(error, ALE_MAP_FILE_ERROR, "%s: %s", path, reason);
    return -1;
}

int ale_map_file_save(const char *path, const ale_map_t *map, char error[ALE_MAP_FILE_ERROR])
{
    return ale_map_file_save_with_pose(path, map, NULL, error);
}

int ale_map_file_save_with_pose(const char *path, const ale_map_t *map, const ale_pose_t *pose,
                                char error[ALE_MAP_FILE_ERROR])
{
    size_t count = 0;
    char *text = ale_map_text_print(map, pose, &count);
    if (!text) {
        return fail(error, path, "not enough memory");
    }
    ale_whole_file_t file;
    int status = ale_whole_file_begin(&file, path, RIGHTS);
    if (status == 0) {
        fwrite(text, 1, count, file.out);
        status = ale_whole_file_commit(&file);
    }
    const int reason = errno; /* free may set another */
    free(text);
    return status < 0 ? fail(error, path, ale_whole_file_words(reason)) : 0;
}

int ale_map_file_load(const char *path, ale_map_t *map, char error[ALE_MAP_FILE_ERROR])
{
    ale_pose_t pose;
    bool known = false;
    return ale_map_file_load_with_pose(path, map, &pose, &known, error);
}

int ale_map_file_load_with_pose(const char *path, ale_map_t *map, ale_pose_t *pose, bool *known,
                                char error[ALE_MAP_FILE_ERROR])
{
    ale_bytes_t bytes;
    struct stat status;
    const char *wrong =
        ale_bytes_read_regular(&bytes, path, &(ale_bytes_rule_t){.most = ALE_MAP_TEXT_MOST}, &status);
    ale_map_text_t *loaded = wrong ? NULL : calloc(1, sizeof *loaded);
    uint64_t line_number = 0;
    if (loaded) {
        line_number = 1;
        wrong = ale_map_text_parse(bytes.at, bytes.count, loaded, &line_number);
    } else if (!wrong) {
        wrong = "not enough memory";
    }
    if (loaded && !wrong) {
        loaded->map.version = 1;
        *map = loaded->map;
        *known = loaded->pose_known;
        if (loaded->pose_known) {
            *pose = loaded->pose;
        }
    }
    free(loaded);
    ale_bytes_free(&bytes);
    if (wrong && line_number > 0) {
        snprintf(error, ALE_MAP_FILE_ERROR, "%s: line %" PRIu64 ": %s", path, line_number, wrong);
    } else if (wrong) {
        snprintf(error, ALE_MAP_FILE_ERROR, "%s: %s", path, wrong);
    }
    return wrong ? -1 : 0;
}
