/* ale-keys: makes an operator's key, and lists whom a robot obeys. */
#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "command/keys.h"

enum { FINE = 0, FAILED = 1, WRONG_USE = 2, PATH_BYTES = 4096, LIST = 'l', ROBOT = 'r', SECRET = 's' };

static const char help[] =
    "usage: ale-keys NAME [--secret FILE] [--robot FILE]\n"
    "       ale-keys --list FILE\n"
    "\n"
    "Makes a key for the operator NAME: a secret one, which he signs his commands with, and a line in the\n"
    "robot's list, which says whom it obeys.\n"
    "\n"
    "  --secret FILE  the operator's secret key, readable by its owner alone (default: NAME.key);\n"
    "                 for ale-send --keys and ale-console --keys\n"
    "  --robot FILE   the robot's list; made, or NAME is added to it (default: robot.keys);\n"
    "                 for ale-slamd --keys\n"
    "  --list FILE    prints who is in a robot's list\n"
    "  --help, --version\n"
    "\n"
    "To take the right away from somebody, take his line out of the robot's list and restart ale-slamd.\n"
    "Exit status: 0 fine, 1 failed, 2 wrong use.\n";

static int fail(int status, const char *reason)
{
    fprintf(stderr, "ale-keys: %s\n", reason);
    return status;
}

static int list(const char *path)
{
    ale_keys_t keys;
    char error[ALE_KEYS_ERROR];
    if (ale_keys_load(path, &keys, error) < 0) {
        return fail(FAILED, error);
    }
    for (uint32_t k = 0; k < keys.count; k++) {
        puts(keys.operator_key[k].name);
    }
    return FINE;
}

/* The list with the new line in it, not yet written. */
static int extend(const char *path, const ale_public_key_t *added, ale_keys_t *keys,
                  char error[ALE_KEYS_ERROR])
{
    *keys = (ale_keys_t){0};
    if (access(path, F_OK) == 0 && ale_keys_load(path, keys, error) < 0) {
        return -1;
    }
    for (uint32_t k = 0; k < keys->count; k++) {
        if (strcmp(keys->operator_key[k].name, added->name) == 0) {
            snprintf(error, ALE_KEYS_ERROR, "%.200s: %s is there already", path, added->name);
            return -1;
        }
    }
    if (keys->count == ALE_MAX_KEYS) {
        snprintf(error, ALE_KEYS_ERROR, "%.200s: full, %d operators", path, ALE_MAX_KEYS);
        return -1;
    }
    keys->operator_key[keys->count++] = *added;
    return 0;
}

static int make(const char *name, const char *secret_path, const char *robot_path)
{
    ale_secret_key_t secret;
    ale_public_key_t added;
    ale_keys_t keys;
    char error[ALE_KEYS_ERROR];
    if (ale_keys_make(name, &secret, &added) < 0) {
        return fail(WRONG_USE, "a name is 1 to 31 letters, digits, '-', '_', '.'");
    }
    if (extend(robot_path, &added, &keys, error) < 0 ||
        ale_secret_key_save(secret_path, &secret, error) < 0) {
        return fail(FAILED, error);
    }
    if (ale_keys_save(robot_path, &keys, error) < 0) {
        unlink(secret_path);
        return fail(FAILED, error);
    }
    printf("%s: secret key of %s\n%s: the robot's list, %u of %d\n", secret_path, name, robot_path,
           keys.count, ALE_MAX_KEYS);
    return FINE;
}

int main(int count, char **arguments)
{
    static const struct option known[] = {
        {"secret", required_argument, NULL, SECRET}, {"robot", required_argument, NULL, ROBOT},
        {"list", required_argument, NULL, LIST},     {"help", no_argument, NULL, 'h'},
        {"version", no_argument, NULL, 'v'},         {NULL, 0, NULL, 0},
    };
    const char *secret = NULL;
    const char *robot = "robot.keys";
    for (int choice; (choice = getopt_long(count, arguments, "", known, NULL)) != -1;) {
        switch (choice) {
        case SECRET:
            secret = optarg;
            break;
        case ROBOT:
            robot = optarg;
            break;
        case LIST:
            return list(optarg);
        case 'h':
            fputs(help, stdout);
            return FINE;
        case 'v':
            puts("ale-keys 0.1.0");
            return FINE;
        default:
            return WRONG_USE;
        }
    }
    if (optind + 1 != count) {
        return fail(WRONG_USE, "whose key? (--help tells the options)");
    }
    char own[PATH_BYTES];
    snprintf(own, sizeof own, "%s.key", arguments[optind]);
    return make(arguments[optind], secret ? secret : own, robot);
}
