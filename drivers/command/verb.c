#include "command/verb.h"

#include <stdio.h>
#include <string.h>

typedef struct {
    const char *name;
    uint32_t least_args;
    uint32_t most_args;
} form_t;

static const form_t verbs[ALE_VERBS] = {
    [ALE_VERB_DRIVE] = {"drive", 2, 2},       [ALE_VERB_STOP] = {"stop", 0, 0},
    [ALE_VERB_EXPLORE] = {"explore", 1, 1},   [ALE_VERB_RESET] = {"reset", 0, 0},
    [ALE_VERB_RELOCATE] = {"relocate", 3, 3}, [ALE_VERB_SAVE_MAP] = {"save_map", 1, 1},
    [ALE_VERB_LOAD_MAP] = {"load_map", 1, 4}, [ALE_VERB_RECORD] = {"record", 0, 0},
    [ALE_VERB_SET] = {"set", 2, 2},           [ALE_VERB_GOTO] = {"goto", 2, 2},
};

static const char *const settings[ALE_SETTINGS] = {
    [ALE_SETTING_DRIVE_SPEED] = "drive_speed",
    [ALE_SETTING_DRIVE_TURN] = "drive_turn",
    [ALE_SETTING_PUBLISH_SCAN] = "publish_scan",
    [ALE_SETTING_FREEZE_MAP] = "freeze_map",
};

static int verb_named(const char *name)
{
    for (int verb = 0; verb < ALE_VERBS; verb++) {
        if (strcmp(verbs[verb].name, name) == 0) {
            return verb;
        }
    }
    return -1;
}

int ale_setting_of(const char *name)
{
    for (int setting = 0; setting < ALE_SETTINGS; setting++) {
        if (strcmp(settings[setting], name) == 0) {
            return setting;
        }
    }
    return -1;
}

static void tell_arguments(const form_t *form, uint32_t args, char error[ALE_VERB_ERROR])
{
    if (form->least_args == form->most_args) {
        snprintf(error, ALE_VERB_ERROR, "%s takes %u argument%s, not %u", form->name, form->most_args,
                 form->most_args == 1 ? "" : "s", args);
    } else {
        snprintf(error, ALE_VERB_ERROR, "%s takes %u to %u arguments, not %u", form->name, form->least_args,
                 form->most_args, args);
    }
}

int ale_verb_of(const ale_command_t *command, char error[ALE_VERB_ERROR])
{
    const int verb = verb_named(command->verb);
    if (verb < 0) {
        snprintf(error, ALE_VERB_ERROR, "no verb %s", command->verb);
        return -1;
    }
    const form_t *form = &verbs[verb];
    if (command->args < form->least_args || command->args > form->most_args) {
        tell_arguments(form, command->args, error);
        return -1;
    }
    if (verb == ALE_VERB_SET && ale_setting_of(command->arg[0]) < 0) {
        snprintf(error, ALE_VERB_ERROR, "no setting %s", command->arg[0]);
        return -1;
    }
    return verb;
}
