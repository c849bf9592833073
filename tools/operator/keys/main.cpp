/* ale-keys: makes an operator's key, and lists whom a robot obeys. */
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include "common/command_line/command_line.h"

extern "C" {
#include "command/keys.h"
}

namespace
{

constexpr char usage[] =
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

struct Options {
    std::string name;
    std::string secret;
    std::string robot = "robot.keys";
    std::string list;
};

ale_keys_t load(const std::string &path)
{
    ale_keys_t keys;
    char error[ALE_KEYS_ERROR];
    if (ale_keys_load(path.c_str(), &keys, error) < 0) {
        throw std::runtime_error(error);
    }
    return keys;
}

void list(const std::string &path)
{
    const ale_keys_t keys = load(path);
    for (uint32_t k = 0; k < keys.count; k++) {
        std::puts(keys.operator_key[k].name);
    }
}

/* The robot's list with the new line in it, not yet written. */
ale_keys_t extended(const std::string &path, const ale_public_key_t &added)
{
    ale_keys_t keys = access(path.c_str(), F_OK) == 0 ? load(path) : ale_keys_t{};
    for (uint32_t k = 0; k < keys.count; k++) {
        if (std::strcmp(keys.operator_key[k].name, added.name) == 0) {
            throw std::runtime_error(path + ": " + added.name + " is there already");
        }
    }
    if (keys.count == ALE_MAX_KEYS) {
        throw std::runtime_error(path + ": full, " + std::to_string(ALE_MAX_KEYS) + " operators");
    }
    keys.operator_key[keys.count++] = added;
    return keys;
}

void make(const std::string &name, const std::string &secret_path, const std::string &robot_path)
{
    ale_secret_key_t secret;
    ale_public_key_t added;
    char error[ALE_KEYS_ERROR];
    if (ale_keys_make(name.c_str(), &secret, &added) < 0) {
        throw cli::WrongUse("a name is 1 to 31 letters, digits, '-', '_', '.'");
    }
    const ale_keys_t keys = extended(robot_path, added);
    if (ale_secret_key_save(secret_path.c_str(), &secret, error) < 0) {
        throw std::runtime_error(error);
    }
    if (ale_keys_save(robot_path.c_str(), &keys, error) < 0) {
        unlink(secret_path.c_str());
        throw std::runtime_error(error);
    }
    std::printf("%s: secret key of %s\n%s: the robot's list, %u of %d\n", secret_path.c_str(), name.c_str(),
                robot_path.c_str(), keys.count, ALE_MAX_KEYS);
}

void run(const Options &options)
{
    if (options.name.empty() == options.list.empty()) {
        throw cli::WrongUse("whose key, or which --list?");
    }
    if (!options.list.empty()) {
        list(options.list);
    } else {
        make(options.name, options.secret.empty() ? options.name + ".key" : options.secret, options.robot);
    }
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-keys", usage);
    line.text("secret", options.secret);
    line.text("robot", options.robot);
    line.text("list", options.list);
    line.possible_argument("NAME", options.name);
    return line.run(argc, argv, [&] { run(options); });
}
