/* Which verbs and settings commands may name: the operator's end checks it before it sends, the robot before
 * it obeys. README.md says what each does. Pure functions. */
#ifndef ALE_COMMAND_VERB_H
#define ALE_COMMAND_VERB_H

#include "command/command.h"

typedef enum {
    ALE_VERB_DRIVE,
    ALE_VERB_STOP,
    ALE_VERB_EXPLORE,
    ALE_VERB_RESET,
    ALE_VERB_RELOCATE,
    ALE_VERB_SAVE_MAP,
    ALE_VERB_LOAD_MAP,
    ALE_VERB_RECORD,
    ALE_VERB_SET,
    ALE_VERB_GOTO,
    ALE_VERBS
} ale_verb_t;

/* Of ALE_VERB_SET: its first argument. */
typedef enum {
    ALE_SETTING_DRIVE_SPEED,
    ALE_SETTING_DRIVE_TURN,
    ALE_SETTING_PUBLISH_SCAN,
    ALE_SETTING_FREEZE_MAP,
    ALE_SETTINGS
} ale_setting_t;

enum { ALE_VERB_ERROR = 96 };

/* The command's verb, or -1 and one line in error: there is none of that name, or it takes another number of
 * arguments, or there is no such setting. */
int ale_verb_of(const ale_command_t *command, char error[ALE_VERB_ERROR]);

/* Which setting a name is (ale_setting_t), or -1: none. */
int ale_setting_of(const char *name);

#endif
