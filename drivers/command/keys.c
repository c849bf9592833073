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

static const char KEYS_HEAD[] = "ALE-SLAM keys 1";
static const char SECRET_HEAD[] = "ALE-SLAM operator key 1";

enum {
    SEED_BYTES = crypto_sign_SEEDBYTES,
    HEX_BYTES = 2 * SEED_BYTES + 1,
    LINE_BYTES = 160,
    FILE_MOST = 1 << 16,
    LIST_RIGHTS = 0644
};

_Static_assert((int)ALE_PUBLIC_KEY_BYTES == (int)crypto_sign_PUBLICKEYBYTES, "libsodium's sizes");
_Static_assert((int)ALE_SECRET_KEY_BYTES == (int)crypto_sign_SECRETKEYBYTES, "libsodium's sizes");
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

static int parse_keys(const char *path, ale_text_t text, ale_keys_t *keys, char error[ALE_KEYS_ERROR])
{
    ale_span_t line;
    if (!ale_text_line(&text, &line) || !ale_text_is(line, KEYS_HEAD)) {
        return fail(error, path, "not a robot's list of keys (ale-keys makes it)");
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
    if (file.st_uid != 0 && file.st_uid != geteuid()) {
        return guard->others_own_it;
    }
    return (file.st_mode & guard->forbidden) != 0 ? guard->others_have_it : NULL;
}

int ale_keys_load(const char *path, ale_keys_t *keys, char error[ALE_KEYS_ERROR])
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
    const int status =
        wrong ? fail(error, path, wrong) : parse_keys(path, ale_text(bytes.at, bytes.count), &read, error);
    ale_bytes_free(&bytes);
    if (status == 0) {
        *keys = read;
    }
    return status;
}

int ale_keys_save(const char *path, const ale_keys_t *keys, char error[ALE_KEYS_ERROR])
{
    char text[LINE_BYTES * (ALE_MAX_KEYS + 2)];
    size_t length = (size_t)snprintf(text, sizeof text,
                                     "%s\n# Who may command the robot: name and public key. "
                                     "Taking a line away takes the right away.\n",
                                     KEYS_HEAD);
    for (uint32_t k = 0; k < keys->count; k++) {
        char hex[HEX_BYTES];
        sodium_bin2hex(hex, sizeof hex, keys->operator_key[k].key, ALE_PUBLIC_KEY_BYTES);
        length +=
            (size_t)snprintf(text + length, sizeof text - length, "%s %s\n", keys->operator_key[k].name, hex);
    }
    ale_whole_file_t file;
    int status = ale_whole_file_begin(&file, path, LIST_RIGHTS);
    if (status == 0) {
        fwrite(text, 1, length, file.out);
        status = ale_whole_file_commit(&file);
    }
    return status < 0 ? fail(error, path, ale_whole_file_words(errno)) : 0;
}

int ale_secret_key_save(const char *path, const ale_secret_key_t *secret, char error[ALE_KEYS_ERROR])
{
    uint8_t seed[SEED_BYTES];
    char hex[HEX_BYTES];
    char text[LINE_BYTES];
    crypto_sign_ed25519_sk_to_seed(seed, secret->key);
    sodium_bin2hex(hex, sizeof hex, seed, sizeof seed);
    const int length = snprintf(text, sizeof text, "%s\n%s %s\n", SECRET_HEAD, secret->name, hex);
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    int status = file < 0 ? fail(error, path, strerror(errno)) : 0;
    if (file >= 0) {
        if (write(file, text, (size_t)length) != length || fsync(file) < 0) {
            status = fail(error, path, strerror(errno));
        }
        close(file);
    }
    sodium_memzero(seed, sizeof seed);
    sodium_memzero(hex, sizeof hex);
    sodium_memzero(text, sizeof text);
    return status;
}

static bool parse_secret(ale_text_t text, ale_secret_key_t *secret)
{
    ale_span_t line;
    uint8_t seed[SEED_BYTES];
    uint8_t public_key[ALE_PUBLIC_KEY_BYTES];
    if (!ale_text_line(&text, &line) || !ale_text_is(line, SECRET_HEAD)) {
        return false;
    }
    while (ale_text_line(&text, &line) && is_comment(line)) {
    }
    const bool found =
        take_line(line, secret->name, seed) && crypto_sign_seed_keypair(public_key, secret->key, seed) == 0;
    sodium_memzero(seed, sizeof seed);
    return found;
}

int ale_secret_key_load(const char *path, ale_secret_key_t *secret, char error[ALE_KEYS_ERROR])
{
    static const guard_t guard = {
        .forbidden = S_IRWXG | S_IRWXO,
        .others_have_it = "readable by others: no longer secret (chmod 600)",
        .others_own_it = "belongs to another user, who knows it: it must be root's or your own (chown)",
    };
    ale_bytes_t bytes;
    if (start(error, path) < 0) {
        return -1;
    }
    const char *wrong = read_guarded(path, &guard, &bytes);
    ale_secret_key_t read = {0};
    if (!wrong && !parse_secret(ale_text(bytes.at, bytes.count), &read)) {
        wrong = "not an operator's key (ale-keys makes it)";
    }
    if (!wrong) {
        *secret = read;
    }
    sodium_memzero(&read, sizeof read);
    ale_bytes_free(&bytes);
    return wrong ? fail(error, path, wrong) : 0;
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
