/* An object of the core whose size only the core knows, in memory of its own. */
#ifndef ALE_COMMON_OFFLINE_CORE_OBJECT_H
#define ALE_COMMON_OFFLINE_CORE_OBJECT_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

namespace ale
{

struct FreeCoreObject {
    void operator()(void *memory) const
    {
        operator delete (memory, std::align_val_t{alignof(std::max_align_t)});
    }
};

template <class T> using CoreObject = std::unique_ptr<T, FreeCoreObject>;

template <class T> CoreObject<T> core_object(uint32_t bytes)
{
    return CoreObject<T>(static_cast<T *>(operator new (bytes, std::align_val_t{alignof(std::max_align_t)})));
}

} // namespace ale

#endif
