/* The files of the operator's page, embedded in the program when it is built (tools/make/embed.py). */
#ifndef CONSOLE_PAGE_H
#define CONSOLE_PAGE_H

#include <cstddef>

struct ale_page_file_t {
    const char *name; /* without folder: "index.html" */
    const unsigned char *bytes;
    size_t size;
};

extern const ale_page_file_t ale_page_files[];
extern const unsigned ale_page_file_count;

#endif
