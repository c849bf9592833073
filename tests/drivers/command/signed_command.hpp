/* Commands as an honest operator makes them, for tests to spoil. */
#ifndef TESTS_SIGNED_COMMAND_HPP
#define TESTS_SIGNED_COMMAND_HPP

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

extern "C" {
#include "command/keys.h"
#include "command/verify.h"
}

namespace signed_command
{

constexpr int64_t now_utime = 1700000000000000;
constexpr int64_t boot = 4711;

struct Operator {
    ale_secret_key_t secret;
    ale_public_key_t known;
    explicit Operator(const char *name)
    {
        ale_keys_make(name, &secret, &known);
    }
};

/* A robot's list of those whom it obeys. */
inline ale_keys_t keys_of(const std::vector<Operator> &operators)
{
    ale_keys_t keys{};
    for (const Operator &one : operators) {
        keys.operator_key[keys.count++] = one.known;
    }
    return keys;
}

inline ale_command_t drive(int64_t counter)
{
    ale_command_t command{};
    command.utime = now_utime;
    command.expiry_utime = now_utime + 1000000;
    command.boot = boot;
    command.counter = counter;
    std::snprintf(command.robot, sizeof command.robot, "rover");
    std::snprintf(command.verb, sizeof command.verb, "drive");
    command.args = 2;
    std::snprintf(command.arg[0], sizeof command.arg[0], "0.25");
    std::snprintf(command.arg[1], sizeof command.arg[1], "-0.1");
    return command;
}

inline std::vector<uint8_t> signed_by(const Operator &who, ale_command_t command)
{
    uint8_t bytes[ALE_COMMAND_BYTES];
    const size_t count = ale_command_sign(&command, &who.secret, bytes);
    return {bytes, bytes + count};
}

} // namespace signed_command

#endif
