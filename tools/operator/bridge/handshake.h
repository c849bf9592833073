/* How both ends prove who they are and agree on keys that nobody else has. Pure but for random numbers.
 *
 *   operator ── hello: ephemeral key, name, signature of the operator ──────────────► robot     256 bytes
 *   operator ◄─ answer: both ephemeral keys, session, signature of the robot ──────── robot     150 bytes
 *
 * ed25519 signatures, X25519 with crypto_kx of libsodium. The answer is shorter than the question, so nobody
 * can have the robot send more to somebody than he sends himself; who only plays a hello again does not have
 * the key that the answer is for. What either end has recorded is of no use once both have ended: the
 * ephemeral keys are kept nowhere. */
#ifndef BRIDGE_HANDSHAKE_H
#define BRIDGE_HANDSHAKE_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sodium.h>

extern "C" {
#include "command/keys.h"
}

namespace bridge
{

using PublicHalf = std::array<uint8_t, crypto_kx_PUBLICKEYBYTES>;

struct Ephemeral {
    PublicHalf open{};
    std::array<uint8_t, crypto_kx_SECRETKEYBYTES> secret{};

    static Ephemeral make();
};

struct SessionKeys {
    std::array<uint8_t, crypto_kx_SESSIONKEYBYTES> receive{};
    std::array<uint8_t, crypto_kx_SESSIONKEYBYTES> send{};
};

/* Who says hello, and the ephemeral key that he says it with. */
struct Hello {
    std::string name;
    PublicHalf ephemeral{};
};

struct Answer {
    std::string name; /* of the robot, as the operator's list calls it */
    PublicHalf ephemeral{};
    uint64_t session = 0;
};

constexpr size_t hello_bytes = 256;

std::vector<uint8_t> make_hello(const ale_secret_key_t &key, const PublicHalf &ephemeral);

/* Nothing: not signed by one of these. */
std::optional<Hello> check_hello(const std::vector<uint8_t> &bytes, const ale_keys_t &operators);

std::vector<uint8_t> make_answer(const ale_secret_key_t &robot, const Hello &hello,
                                 const PublicHalf &ephemeral, uint64_t session);

/* Nothing: not signed by one of these robots, or not for this ephemeral key. */
std::optional<Answer> check_answer(const std::vector<uint8_t> &bytes, const ale_keys_t &robots,
                                   const PublicHalf &ephemeral);

/* Nothing for a key of the other end that is none. */
std::optional<SessionKeys> robot_keys(const Ephemeral &own, const PublicHalf &other);
std::optional<SessionKeys> operator_keys(const Ephemeral &own, const PublicHalf &other);

} // namespace bridge

#endif
