/* Bytes of ALE_COMMAND: whatever is decoded must encode to the same bytes again (so what was signed is what
 * is obeyed), and nothing without the right signature is genuine. */
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

extern "C" {
#include "command/message.h"
#include "command/verify.h"
}

namespace
{

void decode_and_encode(const uint8_t *data, size_t size)
{
    ale_command_t command{};
    size_t signed_bytes = 0;
    const ale_message_kind_t kind = ale_command_decode(data, size, &command, &signed_bytes);
    if (kind == ALE_MESSAGE_MALFORMED) {
        return;
    }
    uint8_t again[ALE_COMMAND_BYTES];
    const uint8_t *signature = kind == ALE_MESSAGE_SIGNED ? data + size - ALE_SIGNATURE_BYTES : nullptr;
    if (ale_command_encode(&command, signature, again) != size || std::memcmp(again, data, size) != 0) {
        std::abort();
    }
}

void verify(const uint8_t *data, size_t size)
{
    static const ale_keys_t keys = [] {
        ale_keys_t one{};
        ale_secret_key_t forgotten;
        ale_keys_make("a", &forgotten, &one.operator_key[0]);
        one.count = 1;
        return one;
    }();
    ale_verifier_t verifier;
    ale_verifier_init(&verifier, &keys, "r", 0);
    ale_command_t command;
    if (ale_verify(&verifier, data, size, 0, &command) == ALE_GENUINE) {
        std::abort();
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    decode_and_encode(data, size);
    verify(data, size);
    /* Behind the right fingerprint too, which chance would not find. */
    const ale_command_t empty{};
    uint8_t head[ALE_COMMAND_BYTES];
    ale_command_encode(&empty, nullptr, head);
    std::string typed(reinterpret_cast<const char *>(head), sizeof(int64_t));
    typed.append(reinterpret_cast<const char *>(data), size);
    decode_and_encode(reinterpret_cast<const uint8_t *>(typed.data()), typed.size());
    verify(reinterpret_cast<const uint8_t *>(typed.data()), typed.size());
    return 0;
}
