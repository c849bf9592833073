/* Numbers one after the other in bytes, the same on every machine: the lowest byte first, floating point as
 * IEEE 754 has it, of a list its length before its items.
 *
 *   NumberWriter file;                 NumberReader file(bytes);
 *   file.numbers(x, y);                file.numbers(x, y);
 *   file.count(items);                 file.count(items);      (as many items, to be filled)
 */
#ifndef ALE_LAB_MERGE_NUMBER_FILE_H
#define ALE_LAB_MERGE_NUMBER_FILE_H

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

extern "C" {
#include "file/little_endian.h"
}

namespace merge
{

class NumberWriter
{
  public:
    template <class T> using Passed = const T;

    template <class... Numbers> void numbers(const Numbers &...all)
    {
        (put(all), ...);
    }
    template <class List> void count(const List &list)
    {
        put(static_cast<uint32_t>(list.size()));
    }
    const std::string &bytes() const
    {
        return bytes_;
    }

  private:
    template <class T> void put(T number)
    {
        if constexpr (std::is_floating_point_v<T>) {
            uint64_t bits = 0;
            static_assert(sizeof bits == sizeof number);
            std::memcpy(&bits, &number, sizeof bits);
            put(bits);
        } else {
            uint8_t lowest_first[sizeof(uint64_t)];
            ale_put_u64(lowest_first, static_cast<uint64_t>(number));
            bytes_.append(lowest_first, lowest_first + sizeof number);
        }
    }

    std::string bytes_;
};

/* Whatever does not fit the bytes throws std::runtime_error, and nothing is allocated for what is not there.
 */
class NumberReader
{
  public:
    template <class T> using Passed = T;

    explicit NumberReader(std::string_view bytes) : left_(bytes)
    {
    }
    template <class... Numbers> void numbers(Numbers &...all)
    {
        (take(&all), ...);
    }
    template <class List> void count(List &list)
    {
        uint32_t items = 0;
        take(&items);
        require(items <= left_.size()); /* an item has a byte at least */
        list.resize(items);
    }
    static void require(bool holds)
    {
        if (!holds) {
            throw std::runtime_error("damaged");
        }
    }
    bool is_at_end() const
    {
        return left_.empty();
    }

  private:
    template <class T> void take(T *number)
    {
        require(left_.size() >= sizeof(T));
        uint8_t lowest_first[sizeof(uint64_t)] = {};
        std::memcpy(lowest_first, left_.data(), sizeof(T));
        left_.remove_prefix(sizeof(T));
        const uint64_t bits = ale_get_u64(lowest_first);
        if constexpr (std::is_floating_point_v<T>) {
            static_assert(sizeof bits == sizeof *number);
            std::memcpy(number, &bits, sizeof bits);
            require(std::isfinite(*number));
        } else {
            *number = static_cast<T>(bits);
        }
    }

    std::string_view left_;
};

} // namespace merge

#endif
