/* ale-keys: makes the keys of operators, robots and motor controllers, and lists who obeys and believes whom.
 */
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <pwd.h>
#include <unistd.h>

#include "common/command_line/command_line.h"

extern "C" {
#include "command/keys.h"
}

namespace
{

constexpr char usage[] =
    "usage: ale-keys NAME [--secret FILE] [--robot FILE] [--know LINE]\n"
    "       ale-keys --own NAME [--robot FILE] | --know LINE --secret FILE | --drive FILE | --list FILE\n"
    "\n"
    "Makes a key for the operator NAME: a secret one, which he signs his commands with, and a line in the\n"
    "robot's list, which says whom it obeys. The robot gets a key of its own beside that list, if it has "
    "none,\n"
    "and NAME believes from then on what it says.\n"
    "\n"
    "  --secret FILE  the operator's secret key, readable by its owner alone (default: NAME.key);\n"
    "                 for ale-send --keys and ale-console --keys; the robots he believes: FILE.robots\n"
    "  --robot FILE   the robot's list; made, or NAME is added to it (default: robot.keys);\n"
    "                 for ale-slamd --keys; the robot's own key: FILE.secret\n"
    "  --own NAME     on the robot: makes its own key, if there is none, and prints its public line\n"
    "  --know LINE    with the operator: believe the robot of that line; no key is made for a robot\n"
    "  --drive FILE   makes the key that a robot shares with its motor controller (drive.key)\n"
    "  --list FILE    prints who is in a robot's list\n"
    "  --help, --version\n"
    "\n"
    "To take the right away from somebody, take his line out of the robot's list and restart ale-slamd.\n"
    "Exit status: 0 fine, 1 failed, 2 wrong use.\n";

struct Options {
    std::string name;
    std::string secret;
    std::string robot = "robot.keys";
    std::string own;
    std::string know;
    std::string drive;
    std::string list;
};

using Load = int (*)(const char *, ale_keys_t *, char *);

bool is_there(const std::string &path)
{
    return access(path.c_str(), F_OK) == 0;
}

ale_keys_t load(const std::string &path, Load how)
{
    ale_keys_t keys;
    char error[ALE_KEYS_ERROR];
    if (how(path.c_str(), &keys, error) < 0) {
        throw std::runtime_error(error);
    }
    return keys;
}

void list(const std::string &path)
{
    const ale_keys_t keys = load(path, ale_keys_load);
    for (uint32_t k = 0; k < keys.count; k++) {
        std::puts(keys.operator_key[k].name);
    }
}

const ale_public_key_t *named(const ale_keys_t &keys, const char *name)
{
    for (uint32_t k = 0; k < keys.count; k++) {
        if (std::strcmp(keys.operator_key[k].name, name) == 0) {
            return &keys.operator_key[k];
        }
    }
    return nullptr;
}

/* The list with the new line in it, not yet written. */
ale_keys_t extended(const std::string &path, ale_keys_t keys, const ale_public_key_t &added)
{
    if (named(keys, added.name)) {
        throw std::runtime_error(path + ": " + added.name + " is there already");
    }
    if (keys.count == ALE_MAX_KEYS) {
        throw std::runtime_error(path + ": full, " + std::to_string(ALE_MAX_KEYS) + " names");
    }
    keys.operator_key[keys.count++] = added;
    return keys;
}

/* Made by root beside the list of the service, it must be the service's, or that could not read it. */
void give_to_service(const std::string &path)
{
    const std::string folder = std::filesystem::absolute(path).parent_path().filename().string();
    const passwd *service = geteuid() == 0 && folder == "ale-slam" ? getpwnam("ale-slam") : nullptr;
    if (service && lchown(path.c_str(), service->pw_uid, service->pw_gid) < 0) {
        throw std::runtime_error(path + ": cannot be given to the user ale-slam");
    }
}

/* The robot's own key: what is there, or a new one. */
ale_secret_key_t own_key(const std::string &path, const std::string &name)
{
    ale_secret_key_t own{};
    ale_public_key_t half{};
    char error[ALE_KEYS_ERROR];
    if (is_there(path)) {
        if (ale_robot_key_load(path.c_str(), &own, error) < 0) {
            throw std::runtime_error(error);
        }
        return own;
    }
    if (ale_keys_make(name.c_str(), &own, &half) < 0) {
        throw cli::WrongUse("a name is 1 to 31 letters, digits, '-', '_', '.'");
    }
    if (ale_robot_key_save(path.c_str(), &own, error) < 0) {
        throw std::runtime_error(error);
    }
    give_to_service(path);
    return own;
}

/* From now on the operator believes that robot. One that is believed already is left as it is. */
void believe(const std::string &secret_path, const ale_public_key_t &robot)
{
    const std::string path = secret_path + ALE_ROBOTS_ENDING;
    const ale_keys_t known = is_there(path) ? load(path, ale_robots_load) : ale_keys_t{};
    const ale_public_key_t *same = named(known, robot.name);
    if (same && std::memcmp(same->key, robot.key, sizeof robot.key) == 0) {
        return;
    }
    const ale_keys_t more = extended(path, known, robot);
    char error[ALE_KEYS_ERROR];
    if (ale_robots_save(path.c_str(), &more, error) < 0) {
        throw std::runtime_error(error);
    }
}

ale_public_key_t robot_of(const std::string &line)
{
    ale_public_key_t robot{};
    if (ale_public_key_parse(line.c_str(), &robot) < 0) {
        throw cli::WrongUse("--know wants a line \"NAME KEY\", as ale-keys --own prints it");
    }
    return robot;
}

void make(const Options &options)
{
    const std::string &robot_path = options.robot;
    const std::string secret_path = options.secret.empty() ? options.name + ".key" : options.secret;
    ale_secret_key_t secret;
    ale_public_key_t added;
    char error[ALE_KEYS_ERROR];
    if (ale_keys_make(options.name.c_str(), &secret, &added) < 0) {
        throw cli::WrongUse("a name is 1 to 31 letters, digits, '-', '_', '.'");
    }
    const ale_keys_t keys =
        extended(robot_path, is_there(robot_path) ? load(robot_path, ale_keys_load) : ale_keys_t{}, added);
    if (ale_secret_key_save(secret_path.c_str(), &secret, error) < 0) {
        throw std::runtime_error(error);
    }
    if (ale_keys_save(robot_path.c_str(), &keys, error) < 0) {
        unlink(secret_path.c_str());
        throw std::runtime_error(error);
    }
    std::printf("%s: secret key of %s\n%s: the robot's list, %u of %d\n", secret_path.c_str(),
                options.name.c_str(), robot_path.c_str(), keys.count, ALE_MAX_KEYS);
    if (options.know.empty()) {
        const ale_secret_key_t own = own_key(robot_path + ALE_OWN_KEY_ENDING, "robot");
        believe(secret_path, ale_public_half(&own));
        std::printf("%s%s: the robot's own key; it stays on the robot\n", robot_path.c_str(),
                    ALE_OWN_KEY_ENDING);
    } else {
        believe(secret_path, robot_of(options.know));
    }
    std::printf("%s%s: the robots that %s believes\n", secret_path.c_str(), ALE_ROBOTS_ENDING,
                options.name.c_str());
}

void print_own(const Options &options)
{
    const ale_secret_key_t own = own_key(options.robot + ALE_OWN_KEY_ENDING, options.own);
    const ale_public_key_t half = ale_public_half(&own);
    char text[ALE_PUBLIC_KEY_TEXT];
    ale_public_key_text(&half, text);
    std::puts(text);
}

void make_drive_key(const std::string &path)
{
    ale_drive_key_t key;
    char error[ALE_KEYS_ERROR] = "libsodium finds no random numbers";
    if (ale_drive_key_make(&key) < 0 || ale_drive_key_save(path.c_str(), &key, error) < 0) {
        throw std::runtime_error(error);
    }
    std::printf("%s: for the robot (drive.key) and its motor controller\n", path.c_str());
}

void know(const Options &options)
{
    if (options.secret.empty()) {
        throw cli::WrongUse("--know wants --secret FILE: who believes it?");
    }
    believe(options.secret, robot_of(options.know));
}

void run(const Options &options)
{
    const bool knows = options.name.empty() && !options.know.empty();
    const int wishes =
        !options.name.empty() + !options.list.empty() + !options.own.empty() + !options.drive.empty() + knows;
    if (wishes != 1) {
        throw cli::WrongUse("whose key, or which --list?");
    }
    if (!options.list.empty()) {
        list(options.list);
    } else if (!options.own.empty()) {
        print_own(options);
    } else if (!options.drive.empty()) {
        make_drive_key(options.drive);
    } else if (knows) {
        know(options);
    } else {
        make(options);
    }
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-keys", usage);
    line.text("secret", options.secret);
    line.text("robot", options.robot);
    line.text("own", options.own);
    line.text("know", options.know);
    line.text("drive", options.drive);
    line.text("list", options.list);
    line.possible_argument("NAME", options.name);
    return line.run(argc, argv, [&] { run(options); });
}
