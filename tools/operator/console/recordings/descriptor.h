/* A file descriptor that is closed when its owner goes. */
#ifndef CONSOLE_DESCRIPTOR_H
#define CONSOLE_DESCRIPTOR_H

#include <utility>

#include <unistd.h>

namespace console
{

class Descriptor
{
  public:
    explicit Descriptor(int number = -1) : number_(number)
    {
    }
    Descriptor(Descriptor &&other) noexcept : number_(std::exchange(other.number_, -1))
    {
    }
    Descriptor &operator=(Descriptor &&other) noexcept
    {
        std::swap(number_, other.number_);
        return *this;
    }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    ~Descriptor()
    {
        if (number_ >= 0) {
            close(number_);
        }
    }

    /* Negative: none. */
    int number() const
    {
        return number_;
    }

  private:
    int number_;
};

} // namespace console

#endif
