#include "operator/bridge/session.h"

#include <algorithm>
#include <array>

#include "operator/bridge/wire_bytes.h"

namespace bridge
{

namespace
{

constexpr size_t head = link_head + 16;
constexpr size_t tag = crypto_aead_chacha20poly1305_ietf_ABYTES;

using Nonce = std::array<uint8_t, crypto_aead_chacha20poly1305_ietf_NPUBBYTES>;

Nonce nonce_of(const uint8_t *sequence)
{
    Nonce nonce{};
    std::copy_n(sequence, 8, nonce.end() - 8);
    return nonce;
}

} // namespace

std::optional<uint64_t> session_of(const std::vector<uint8_t> &bytes)
{
    return kind_of(bytes) == Kind::data && bytes.size() > head + tag
               ? std::optional(number_at(&bytes[link_head]))
               : std::nullopt;
}

std::vector<uint8_t> Session::seal(const Frame &frame)
{
    const std::vector<uint8_t> plain = encode(frame);
    if (plain.empty()) {
        return {};
    }
    std::vector<uint8_t> bytes = begin_datagram(Kind::data);
    put_number(bytes, number_);
    put_number(bytes, ++sent_);
    bytes.resize(head + plain.size() + tag);
    const Nonce nonce = nonce_of(&bytes[head - 8]);
    crypto_aead_chacha20poly1305_ietf_encrypt(&bytes[head], nullptr, plain.data(), plain.size(), bytes.data(),
                                              head, nullptr, nonce.data(), keys_.send.data());
    return bytes;
}

bool Session::is_new(uint64_t sequence) const
{
    if (sequence > newest_) {
        return true;
    }
    return sequence > 0 && newest_ - sequence < window && !taken_[sequence % window];
}

void Session::note(uint64_t sequence)
{
    for (uint64_t passed = newest_ + 1; passed <= sequence && passed - newest_ <= window; passed++) {
        taken_[passed % window] = false;
    }
    taken_[sequence % window] = true;
    newest_ = std::max(newest_, sequence);
}

std::optional<Frame> Session::open(const std::vector<uint8_t> &bytes, const Address &from, int64_t now_us)
{
    const uint64_t sequence = number_at(&bytes[head - 8]);
    const Nonce nonce = nonce_of(&bytes[head - 8]);
    plain_.resize(bytes.size() - head - tag);
    if (!is_new(sequence) || crypto_aead_chacha20poly1305_ietf_decrypt(
                                 plain_.data(), nullptr, nullptr, &bytes[head], bytes.size() - head,
                                 bytes.data(), head, nonce.data(), keys_.receive.data()) != 0) {
        return std::nullopt;
    }
    if (sequence > newest_) {
        address_ = from;
    }
    note(sequence);
    opened_ = sequence;
    heard_us_ = now_us;
    return decode(plain_.data(), plain_.size());
}

} // namespace bridge
