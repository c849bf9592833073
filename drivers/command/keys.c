#include "command/keys.h"

#include <errno.h>
#include <fcntl.h>
#include <sodium.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command/message.h"
#include "file/bytes.h"
#include "file/text.h"
#include "file/whole_file.h"

/* How a kind of file begins, what is written into it for people, and what is said of another one. */
typedef struct {
    const char *head;
    const char *comment;
    const char *wrong;
} form_t;

static const form_t KEYS = {
    "ALE-SLAM keys 1",
    "Who may command the robot: name and public key. Taking a line away takes the right away.",
    "not a robot's list of keys (ale-keys makes it)"};
static const form_t ROBOTS = {"ALE-SLAM robots 1",
                              "Robots that are believed: name and public key, as ale-keys --own prints them.",
                              "not a list of robots (ale-keys makes it)"};
static const form_t OPERATOR_KEY = {"ALE-SLAM operator key 1", "",
                                    "not an operator's key (ale-keys makes it)"};
static const form_t ROBOT_KEY = {"ALE-SLAM robot key 1", "",
                                 "not a robot's own key (ale-keys --own makes it)"};
static const form_t DRIVE_KEY = {"ALE-SLAM drive key 1", "",
                                 "not a key for set points (ale-keys --drive makes it)"};

enum {
    SEED_BYTES = crypto_sign_SEEDBYTES,
    HEX_BYTES = 2 * SEED_BYTES + 1,
    LINE_BYTES = 160,
    FILE_MOST = 1 << 16,
    LIST_RIGHTS = 0644
};

_Static_assert((int)ALE_PUBLIC_KEY_BYTES == (int)crypto_sign_PUBLICKEYBYTES, "libsodium's sizes");
_Static_assert((int)ALE_SECRET_KEY_BYTES == (int)crypto_sign_SECRETKEYBYTES, "libsodium's sizes");
_Static_assert((int)ALE_DRIVE_KEY_BYTES == (int)SEED_BYTES, "one line of a file holds a key");
_Static_assert((int)ALE_SIGNATURE_BYTES == (int)crypto_sign_BYTES, "libsodium's sizes");
_Static_assert((int)ALE_PUBLIC_KEY_BYTES == (int)SEED_BYTES, "a line of either file holds as much");

static int fail(char error[ALE_KEYS_ERROR], const char *path, const char *reason)
{
    snprintf(error, ALE_KEYS_ERROR, "%.200s: %s", path, reason);
    return -1;
}

static bool is_name(const char *text, size_t length)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    for (size_t k = 0; k < length; k++) {
        if (!memchr(letters, text[k], sizeof letters - 1)) {
            return false;
        }
    }
    return length > 0 && length < ALE_NAME_BYTES;
}

bool ale_is_name(const char *text)
{
    return is_name(text, strlen(text));
}

static int start(char error[ALE_KEYS_ERROR], const char *path)
{
    return sodium_init() < 0 ? fail(error, path, "libsodium finds no random numbers") : 0;
}

int ale_keys_make(const char *name, ale_secret_key_t *secret, ale_public_key_t *public_key)
{
    if (!ale_is_name(name) || sodium_init() < 0) {
        return -1;
    }
    memset(secret, 0, sizeof *secret);
    memset(public_key, 0, sizeof *public_key);
    memcpy(secret->name, name, strlen(name));
    memcpy(public_key->name, name, strlen(name));
    return crypto_sign_keypair(public_key->key, secret->key);
}

/* "NAME HEX": true, and name and key are set. */
static bool take_line(ale_span_t line, char name[ALE_NAME_BYTES], uint8_t key[SEED_BYTES])
{
    ale_span_t word;
    if (!ale_text_word(&line, &word) || !is_name(word.at, (size_t)(word.end - word.at))) {
        return false;
    }
    memset(name, 0, ALE_NAME_BYTES);
    memcpy(name, word.at, (size_t)(word.end - word.at));
    size_t bytes = 0;
    return ale_text_word(&line, &word) &&
           sodium_hex2bin(key, SEED_BYTES, word.at, (size_t)(word.end - word.at), NULL, &bytes, NULL) == 0 &&
           bytes == SEED_BYTES && !ale_text_word(&line, &word);
}

static bool is_comment(ale_span_t line)
{
    ale_span_t word;
    return !ale_text_word(&line, &word) || *word.at == '#';
}

static bool is_known(const ale_keys_t *keys, const char *name)
{
    for (uint32_t k = 0; k < keys->count; k++) {
        if (strcmp(keys->operator_key[k].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* NULL, or what is wrong in the line. */
static const char *take_key(ale_span_t line, ale_keys_t *keys)
{
    ale_public_key_t key;
    if (!take_line(line, key.name, key.key)) {
        return "not a name and 64 digits in hex";
    }
    if (!crypto_core_ed25519_is_valid_point(key.key)) {
        return "no key that could be safe";
    }
    if (is_known(keys, key.name)) {
        return "a name that was there already";
    }
    if (keys->count == ALE_MAX_KEYS) {
        return "more keys than a robot keeps";
    }
    keys->operator_key[keys->count++] = key;
    return NULL;
}

static int parse_keys(const form_t *form, const char *path, ale_text_t text, ale_keys_t *keys,
                      char error[ALE_KEYS_ERROR])
{
    ale_span_t line;
    if (!ale_text_line(&text, &line) || !ale_text_is(line, form->head)) {
        return fail(error, path, form->wrong);
    }
    while (ale_text_line(&text, &line)) {
        const char *wrong = is_comment(line) ? NULL : take_key(line, keys);
        if (wrong) {
            snprintf(error, ALE_KEYS_ERROR, "%.200s:%llu: %s", path, (unsigned long long)text.line, wrong);
            return -1;
        }
    }
    return 0;
}

/* Who may have which file of keys. */
typedef struct {
    mode_t forbidden; /* rights that nobody but the owner may have */
    bool root_reads;  /* root takes what is another user's: the service's own secret */
    const char *others_have_it;
    const char *others_own_it;
} guard_t;

/* Reads a file that is guarded as it must be. NULL, or what is wrong. */
static const char *read_guarded(const char *path, const guard_t *guard, ale_bytes_t *bytes)
{
    struct stat file;
    const ale_bytes_rule_t rule = {.most = FILE_MOST, .follow_links = true};
    const char *wrong = ale_bytes_read_regular(bytes, path, &rule, &file);
    if (wrong) {
        return wrong;
    }
    const bool may_read = guard->root_reads && geteuid() == 0;
    if (file.st_uid != 0 && file.st_uid != geteuid() && !may_read) {
        return guard->others_own_it;
    }
    return (file.st_mode & guard->forbidden) != 0 ? guard->others_have_it : NULL;
}

static int load_list(const form_t *form, const char *path, ale_keys_t *keys, char error[ALE_KEYS_ERROR])
{
    static const guard_t guard = {
        .forbidden = S_IWGRP | S_IWOTH,
        .others_have_it = "writable by others than its owner: they could add a key (chmod go-w)",
        .others_own_it =
            "belongs to another user, who could add a key: it must be root's or your own (chown)",
    };
    ale_bytes_t bytes;
    if (start(error, path) < 0) {
        return -1;
    }
    const char *wrong = read_guarded(path, &guard, &bytes);
    ale_keys_t read = {0};
    const int status = wrong ? fail(error, path, wrong)
                             : parse_keys(form, path, ale_text(bytes.at, bytes.count), &read, error);
    ale_bytes_free(&bytes);
    if (status == 0) {
        *keys = read;
    }
    return status;
}

int ale_keys_load(const char *path, ale_keys_t *keys, char error[ALE_KEYS_ERROR])
{
    return load_list(&KEYS, path, keys, error);
}

int ale_robots_load(const char *path, ale_keys_t *robots, char error[ALE_KEYS_ERROR])
{
    return load_list(&ROBOTS, path, robots, error);
}

void ale_public_key_text(const ale_public_key_t *key, char text[ALE_PUBLIC_KEY_TEXT])
{
    char hex[HEX_BYTES];
    sodium_bin2hex(hex, sizeof hex, key->key, ALE_PUBLIC_KEY_BYTES);
    snprintf(text, ALE_PUBLIC_KEY_TEXT, "%s %s", key->name, hex);
}

int ale_public_key_parse(const char *text, ale_public_key_t *key)
{
    ale_keys_t one = {0};
    const ale_span_t line = {.at = text, .end = text + strlen(text)};
    if (sodium_init() < 0 || take_key(line, &one)) {
        return -1;
    }
    *key = one.operator_key[0];
    return 0;
}

static int save_list(const form_t *form, const char *path, const ale_keys_t *keys, char error[ALE_KEYS_ERROR])
{
    char text[LINE_BYTES * (ALE_MAX_KEYS + 2)];
    size_t length = (size_t)snprintf(text, sizeof text, "%s\n# %s\n", form->head, form->comment);
    for (uint32_t k = 0; k < keys->count; k++) {
        char line[ALE_PUBLIC_KEY_TEXT];
        ale_public_key_text(&keys->operator_key[k], line);
        length += (size_t)snprintf(text + length, sizeof text - length, "%s\n", line);
    }
    ale_whole_file_t file;
    int status = ale_whole_file_begin(&file, path, LIST_RIGHTS);
    if (status == 0) {
        fwrite(text, 1, length, file.out);
        status = ale_whole_file_commit(&file);
    }
    return status < 0 ? fail(error, path, ale_whole_file_words(errno)) : 0;
}

int ale_keys_save(const char *path, const ale_keys_t *keys, char error[ALE_KEYS_ERROR])
{
    return save_list(&KEYS, path, keys, error);
}

int ale_robots_save(const char *path, const ale_keys_t *robots, char error[ALE_KEYS_ERROR])
{
    return save_list(&ROBOTS, path, robots, error);
}

/* A new file with one secret line, for its owner alone: there whole, or not at all. */
static int save_secret(const form_t *form, const char *path, const char *name, const uint8_t seed[SEED_BYTES],
                       char error[ALE_KEYS_ERROR])
{
    char hex[HEX_BYTES];
    char text[LINE_BYTES];
    sodium_bin2hex(hex, sizeof hex, seed, SEED_BYTES);
    const int length = snprintf(text, sizeof text, "%s\n%s %s\n", form->head, name, hex);
    ale_whole_file_t file;
    int status = ale_whole_file_begin(&file, path, S_IRUSR | S_IWUSR);
    if (status == 0) {
        setvbuf(file.out, NULL, _IONBF, 0); /* no copy stays in a buffer */
        fwrite(text, 1, (size_t)length, file.out);
        status = ale_whole_file_commit_new(&file);
    }
    status = status < 0 ? fail(error, path, ale_whole_file_words(errno)) : 0;
    sodium_memzero(hex, sizeof hex);
    sodium_memzero(text, sizeof text);
    return status;
}

static int save_key(const form_t *form, const char *path, const ale_secret_key_t *secret,
                    char error[ALE_KEYS_ERROR])
{
    uint8_t seed[SEED_BYTES];
    crypto_sign_ed25519_sk_to_seed(seed, secret->key);
    const int status = save_secret(form, path, secret->name, seed, error);
    sodium_memzero(seed, sizeof seed);
    return status;
}

int ale_secret_key_save(const char *path, const ale_secret_key_t *secret, char error[ALE_KEYS_ERROR])
{
    return save_key(&OPERATOR_KEY, path, secret, error);
}

int ale_robot_key_save(const char *path, const ale_secret_key_t *secret, char error[ALE_KEYS_ERROR])
{
    return save_key(&ROBOT_KEY, path, secret, error);
}

int ale_drive_key_save(const char *path, const ale_drive_key_t *key, char error[ALE_KEYS_ERROR])
{
    return save_secret(&DRIVE_KEY, path, "drive", key->key, error);
}

int ale_drive_key_make(ale_drive_key_t *key)
{
    if (sodium_init() < 0) {
        return -1;
    }
    randombytes_buf(key->key, sizeof key->key);
    return 0;
}

static bool parse_secret(const form_t *form, ale_text_t text, char name[ALE_NAME_BYTES],
                         uint8_t seed[SEED_BYTES])
{
    ale_span_t line;
    if (!ale_text_line(&text, &line) || !ale_text_is(line, form->head)) {
        return false;
    }
    while (ale_text_line(&text, &line) && is_comment(line)) {
    }
    return take_line(line, name, seed);
}

/* The one line of a file with a secret. */
static int load_secret(const form_t *form, const char *path, char name[ALE_NAME_BYTES],
                       uint8_t seed[SEED_BYTES], char error[ALE_KEYS_ERROR])
{
    const guard_t guard = {
        .forbidden = S_IRWXG | S_IRWXO,
        .root_reads = form == &ROBOT_KEY,
        .others_have_it = "readable by others: no longer secret (chmod 600)",
        .others_own_it = "belongs to another user, who knows it: it must be root's or your own (chown)",
    };
    ale_bytes_t bytes;
    if (start(error, path) < 0) {
        return -1;
    }
    const char *wrong = read_guarded(path, &guard, &bytes);
    if (!wrong && !parse_secret(form, ale_text(bytes.at, bytes.count), name, seed)) {
        wrong = form->wrong;
    }
    ale_bytes_free(&bytes);
    return wrong ? fail(error, path, wrong) : 0;
}

static int load_key(const form_t *form, const char *path, ale_secret_key_t *secret,
                    char error[ALE_KEYS_ERROR])
{
    char name[ALE_NAME_BYTES];
    uint8_t seed[SEED_BYTES];
    uint8_t public_key[ALE_PUBLIC_KEY_BYTES];
    int status = load_secret(form, path, name, seed, error);
    if (status == 0) {
        memcpy(secret->name, name, sizeof secret->name);
        status = crypto_sign_seed_keypair(public_key, secret->key, seed);
    }
    sodium_memzero(seed, sizeof seed);
    return status;
}

int ale_secret_key_load(const char *path, ale_secret_key_t *secret, char error[ALE_KEYS_ERROR])
{
    return load_key(&OPERATOR_KEY, path, secret, error);
}

int ale_robot_key_load(const char *path, ale_secret_key_t *secret, char error[ALE_KEYS_ERROR])
{
    return load_key(&ROBOT_KEY, path, secret, error);
}

int ale_drive_key_load(const char *path, ale_drive_key_t *key, char error[ALE_KEYS_ERROR])
{
    char name[ALE_NAME_BYTES];
    uint8_t bytes[SEED_BYTES];
    const int status = load_secret(&DRIVE_KEY, path, name, bytes, error);
    if (status == 0) {
        memcpy(key->key, bytes, sizeof key->key);
    }
    sodium_memzero(bytes, sizeof bytes);
    return status;
}

ale_public_key_t ale_public_half(const ale_secret_key_t *secret)
{
    ale_public_key_t half;
    memcpy(half.name, secret->name, sizeof half.name);
    crypto_sign_ed25519_sk_to_pk(half.key, secret->key);
    return half;
}

size_t ale_command_sign(ale_command_t *command, const ale_secret_key_t *secret,
                        uint8_t bytes[ALE_COMMAND_BYTES])
{
    uint8_t signature[ALE_SIGNATURE_BYTES];
    memcpy(command->operator_name, secret->name, sizeof command->operator_name);
    const size_t unsigned_bytes = ale_command_encode(command, NULL, bytes);
    if (unsigned_bytes == 0) {
        return 0;
    }
    crypto_sign_detached(signature, NULL, bytes, unsigned_bytes - sizeof(int32_t), secret->key);
    return ale_command_encode(command, signature, bytes);
}
