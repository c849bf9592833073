/* Names and handles: one name space for tasks, semaphores and mailboxes. */
#include <ctype.h>
#include <stdint.h>

#include "internal.h"

static unsigned long last_name;

static struct {
    unsigned long name;
    void *handle;
} names[4 * OBJECTS];

void *rtai_handle(unsigned kind, int slot)
{
    return (void *)(0xffff888000000000U + ((uintptr_t)kind << 16) + (uintptr_t)slot * 64);
}

int rtai_slot(unsigned kind, const void *handle)
{
    const uintptr_t offset = (uintptr_t)handle - (uintptr_t)rtai_handle(kind, 0);
    if (offset >= (uintptr_t)OBJECTS * 64 || offset % 64 != 0) {
        rtai_misuse("a handle that is none of its kind");
    }
    return (int)(offset / 64);
}

bool rtai_register(unsigned long name, void *handle)
{
    int free_place = -1;
    for (int k = 4 * OBJECTS - 1; k >= 0; k--) {
        if (name != 0 && names[k].name == name) {
            return false;
        }
        free_place = names[k].name == 0 ? k : free_place;
    }
    if (name == 0 || free_place < 0) {
        return false;
    }
    names[free_place].name = name;
    names[free_place].handle = handle;
    return true;
}

void rtai_unregister(void *handle)
{
    for (int k = 0; k < 4 * OBJECTS; k++) {
        if (names[k].handle == handle) {
            names[k].name = 0;
            names[k].handle = NULL;
        }
    }
}

void *rt_get_adr(unsigned long name)
{
    void *found = NULL;
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    for (int k = 0; k < 4 * OBJECTS; k++) {
        found = name != 0 && names[k].name == name ? names[k].handle : found;
    }
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return found;
}

unsigned long rtai_next_name(void)
{
    return 0xF0000000UL + ++last_name;
}

/* For no object: a name that nobody has. */
unsigned long rt_get_name(void *object)
{
    unsigned long name = 0;
    rtai_enter();
    pthread_mutex_lock(&rtai_lock);
    for (int k = 0; k < 4 * OBJECTS; k++) {
        name = object && names[k].handle == object ? names[k].name : name;
    }
    name = object ? name : rtai_next_name();
    pthread_mutex_unlock(&rtai_lock);
    rtai_leave();
    return name;
}

static unsigned long digit_of(char c)
{
    const char *others = "_@.";
    if (isalpha((unsigned char)c)) {
        return (unsigned long)(toupper((unsigned char)c) - 'A') + 1;
    }
    if (isdigit((unsigned char)c)) {
        return (unsigned long)(c - '0') + 27;
    }
    const char *found = strchr(others, c);
    return found ? 37 + (unsigned long)(found - others) : 0;
}

unsigned long nam2num(const char *name)
{
    unsigned long number = 0;
    for (int k = 0; k < 6 && name[k]; k++) {
        number = number * 40 + digit_of(name[k]);
    }
    return number + 2;
}
