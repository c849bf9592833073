#include "operator/bridge/handshake.h"

#include <algorithm>
#include <cstring>

#include "operator/bridge/wire_bytes.h"

namespace bridge
{

namespace
{

constexpr size_t half = crypto_kx_PUBLICKEYBYTES;
constexpr size_t signature = crypto_sign_BYTES;
constexpr size_t number = 8;
constexpr size_t answer_bytes = link_head + 2 * half + 2 * number + signature;

PublicHalf half_at(const uint8_t *bytes)
{
    PublicHalf key;
    std::copy_n(bytes, half, key.begin());
    return key;
}

void append_signature(std::vector<uint8_t> &bytes, const ale_secret_key_t &key)
{
    std::array<uint8_t, signature> made;
    crypto_sign_detached(made.data(), nullptr, bytes.data(), bytes.size(), key.key);
    bytes.insert(bytes.end(), made.begin(), made.end());
}

/* The one of the list who has signed all bytes before the signature at their end. */
const ale_public_key_t *signer(const std::vector<uint8_t> &bytes, const ale_public_key_t *key)
{
    const size_t signed_bytes = bytes.size() - signature;
    const bool genuine =
        key && crypto_sign_verify_detached(&bytes[signed_bytes], bytes.data(), signed_bytes, key->key) == 0;
    return genuine ? key : nullptr;
}

template <class Is> const ale_public_key_t *find(const ale_keys_t &keys, Is is)
{
    const ale_public_key_t *end = keys.operator_key + keys.count;
    const ale_public_key_t *found = std::find_if(keys.operator_key, end, is);
    return found == end ? nullptr : found;
}

} // namespace

Ephemeral Ephemeral::make()
{
    Ephemeral made;
    crypto_kx_keypair(made.open.data(), made.secret.data());
    return made;
}

std::vector<uint8_t> make_hello(const ale_secret_key_t &key, const PublicHalf &ephemeral)
{
    std::vector<uint8_t> bytes = begin_datagram(Kind::hello);
    bytes.insert(bytes.end(), ephemeral.begin(), ephemeral.end());
    bytes.insert(bytes.end(), key.name, key.name + ALE_NAME_BYTES);
    bytes.resize(hello_bytes - signature);
    append_signature(bytes, key);
    return bytes;
}

std::optional<Hello> check_hello(const std::vector<uint8_t> &bytes, const ale_keys_t &operators)
{
    if (bytes.size() != hello_bytes) {
        return std::nullopt;
    }
    const char *name = reinterpret_cast<const char *>(&bytes[link_head + half]);
    const auto *key = signer(bytes, find(operators, [name](const ale_public_key_t &one) {
                                 return std::memcmp(one.name, name, ALE_NAME_BYTES) == 0;
                             }));
    return key ? std::optional(Hello{key->name, half_at(&bytes[link_head])}) : std::nullopt;
}

std::vector<uint8_t> make_answer(const ale_secret_key_t &robot, const Hello &hello,
                                 const PublicHalf &ephemeral, uint64_t session)
{
    const ale_public_key_t own = ale_public_half(&robot);
    std::vector<uint8_t> bytes = begin_datagram(Kind::answer);
    bytes.insert(bytes.end(), hello.ephemeral.begin(), hello.ephemeral.end());
    bytes.insert(bytes.end(), ephemeral.begin(), ephemeral.end());
    bytes.insert(bytes.end(), own.key, own.key + number);
    put_number(bytes, session);
    append_signature(bytes, robot);
    return bytes;
}

std::optional<Answer> check_answer(const std::vector<uint8_t> &bytes, const ale_keys_t &robots,
                                   const PublicHalf &ephemeral)
{
    if (bytes.size() != answer_bytes || half_at(&bytes[link_head]) != ephemeral) {
        return std::nullopt;
    }
    const uint8_t *robot = &bytes[link_head + 2 * half];
    const auto *key = signer(bytes, find(robots, [robot](const ale_public_key_t &one) {
                                 return std::memcmp(one.key, robot, number) == 0;
                             }));
    return key ? std::optional(
                     Answer{key->name, half_at(&bytes[link_head + half]), number_at(robot + number)})
               : std::nullopt;
}

std::optional<SessionKeys> robot_keys(const Ephemeral &own, const PublicHalf &other)
{
    SessionKeys keys;
    const int status = crypto_kx_server_session_keys(keys.receive.data(), keys.send.data(), own.open.data(),
                                                     own.secret.data(), other.data());
    return status == 0 ? std::optional(keys) : std::nullopt;
}

std::optional<SessionKeys> operator_keys(const Ephemeral &own, const PublicHalf &other)
{
    SessionKeys keys;
    const int status = crypto_kx_client_session_keys(keys.receive.data(), keys.send.data(), own.open.data(),
                                                     own.secret.data(), other.data());
    return status == 0 ? std::optional(keys) : std::nullopt;
}

} // namespace bridge
