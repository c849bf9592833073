/* Keys (ed25519) of operators and robots: made, kept in files, and used to sign.
 *
 *   alice.key, readable by her alone           robot.keys: whom the robot obeys, one line an operator
 *     ALE-SLAM operator key 1                    ALE-SLAM keys 1
 *     alice 3f09...  (32 bytes in hex)           alice a71c...  (32 bytes in hex)
 *
 *   robot.keys.secret, the robot's own         alice.key.robots: whom she believes, one line a robot
 *     ALE-SLAM robot key 1                       ALE-SLAM robots 1
 *     rover 77b0...                              rover 5d12...
 *
 *   drive.key, the robot's and its motor controller's (the same file on both)
 *     ALE-SLAM drive key 1
 *     drive 19ce...
 *
 * Lines with # are for people. Names: 1 to 31 letters, digits, '-', '_', '.'. Files are read by ordinary
 * threads; errors are one line that names the file. */
#ifndef ALE_COMMAND_KEYS_H
#define ALE_COMMAND_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "command/command.h"

enum { ALE_MAX_KEYS = 16, ALE_PUBLIC_KEY_BYTES = 32, ALE_SECRET_KEY_BYTES = 64, ALE_KEYS_ERROR = 320 };
enum { ALE_DRIVE_KEY_BYTES = 32, ALE_PUBLIC_KEY_TEXT = ALE_NAME_BYTES + 2 * ALE_PUBLIC_KEY_BYTES + 1 };

typedef struct {
    char name[ALE_NAME_BYTES];
    uint8_t key[ALE_PUBLIC_KEY_BYTES];
} ale_public_key_t;

/* Who may command a robot. All zero: nobody. */
typedef struct {
    uint32_t count;
    ale_public_key_t operator_key[ALE_MAX_KEYS];
} ale_keys_t;

typedef struct {
    char name[ALE_NAME_BYTES];
    uint8_t key[ALE_SECRET_KEY_BYTES];
} ale_secret_key_t;

/* The first half is for what the robot says, the second for what the motor side says. */
typedef struct {
    uint8_t key[ALE_DRIVE_KEY_BYTES];
} ale_drive_key_t;

/* Could be the name of an operator. */
bool ale_is_name(const char *text);

/* A new pair from the system's random numbers. 0, or -1: the name is none, or libsodium finds no random
 * numbers. */
int ale_keys_make(const char *name, ale_secret_key_t *secret, ale_public_key_t *public_key);

/* The robot's file. 0, or -1 with one line in error: not there or not readable (the system's words), a
 * directory or no regular file, of another owner than root or this process, writable by others than its owner
 * (they could add themselves), above 64 KiB, no list of keys, a line that is no key, a name
 * twice, too many, no memory. Then *keys is untouched. */
int ale_keys_load(const char *path, ale_keys_t *keys, char error[ALE_KEYS_ERROR]);

/* Writes the whole file beside the old one and renames. 0, or -1 with the system's words in error: the file
 * is as it was. */
int ale_keys_save(const char *path, const ale_keys_t *keys, char error[ALE_KEYS_ERROR]);

/* The operator's file: a new one with rights 0600. 0, or -1 with the system's words in error: there is one
 * already, or it cannot be written. */
int ale_secret_key_save(const char *path, const ale_secret_key_t *secret, char error[ALE_KEYS_ERROR]);

/* 0, or -1 with one line in error: as for the robot's file, and others may read it, no operator's key, no
 * random numbers, no memory. Then *secret is untouched. */
int ale_secret_key_load(const char *path, ale_secret_key_t *secret, char error[ALE_KEYS_ERROR]);

/* The same for a robot's own key, and for an operator's list of the robots that he believes. */
int ale_robot_key_save(const char *path, const ale_secret_key_t *secret, char error[ALE_KEYS_ERROR]);
int ale_robot_key_load(const char *path, ale_secret_key_t *secret, char error[ALE_KEYS_ERROR]);
int ale_robots_save(const char *path, const ale_keys_t *robots, char error[ALE_KEYS_ERROR]);
int ale_robots_load(const char *path, ale_keys_t *robots, char error[ALE_KEYS_ERROR]);

/* The same for the key that a robot shares with its motor controller: any 32 bytes. ale_drive_key_make: 0, or
 * -1 when libsodium finds no random numbers. */
int ale_drive_key_make(ale_drive_key_t *key);
int ale_drive_key_save(const char *path, const ale_drive_key_t *key, char error[ALE_KEYS_ERROR]);
int ale_drive_key_load(const char *path, ale_drive_key_t *key, char error[ALE_KEYS_ERROR]);

/* Where the robot's own key lies beside its list, and the robots that an operator believes beside his key,
 * when nothing else is said: the path with ALE_OWN_KEY_ENDING or ALE_ROBOTS_ENDING behind. */
#define ALE_OWN_KEY_ENDING ".secret"
#define ALE_ROBOTS_ENDING ".robots"

/* The public half of a secret key. */
ale_public_key_t ale_public_half(const ale_secret_key_t *secret);

/* The key's line in a list, "NAME HEX", without an end of line; and back: 0, or -1 when it is none. */
void ale_public_key_text(const ale_public_key_t *key, char text[ALE_PUBLIC_KEY_TEXT]);
int ale_public_key_parse(const char *text, ale_public_key_t *key);

/* Signs in the name of the key's owner: command->operator_name is set. Length of the message, or 0 when the
 * command is too long. About 0.1 ms. */
size_t ale_command_sign(ale_command_t *command, const ale_secret_key_t *secret,
                        uint8_t bytes[ALE_COMMAND_BYTES]);

#endif
