// Random numbers that are the same with every compiler and library: the engine of the standard is
// specified to the bit, its distributions are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace bench
{

class Random
{
  public:
    explicit Random(std::uint64_t seed) : engine(seed)
    {
    }

    // 0 <= value < 1
    double unit()
    {
        return static_cast<double>(engine() >> 11) * 0x1p-53;
    }
    double uniform(double low, double high)
    {
        return low + (high - low) * unit();
    }
    bool chance(double probability)
    {
        return unit() < probability;
    }
    // low..high, both included
    int integer(int low, int high)
    {
        return low + static_cast<int>(unit() * (high - low + 1));
    }
    double sign()
    {
        return chance(0.5) ? 1 : -1;
    }
    // Box and Muller, one of the pair.
    double normal()
    {
        const double radius = std::sqrt(-2 * std::log(1 - unit()));
        return radius * std::cos(6.28318530717958647692 * unit());
    }

  private:
    std::mt19937_64 engine;
};

} // namespace bench
