/* A result file that need not be wanted.
 *
 *     sim::OutFile truth(options.truth);       empty: get() is nullptr
 *     std::fprintf(truth.get(), ...);
 *     truth.finish();                          throws when the disk is full */
#ifndef ALE_LAB_SIM_OUT_FILE_H
#define ALE_LAB_SIM_OUT_FILE_H

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace sim
{

class OutFile
{
  public:
    /* Throws std::runtime_error naming the file and the reason. */
    explicit OutFile(const std::string &path) : path_(path), file_(path.empty() ? nullptr : open())
    {
    }
    ~OutFile()
    {
        if (file_) {
            std::fclose(file_);
        }
    }
    OutFile(const OutFile &) = delete;
    OutFile &operator=(const OutFile &) = delete;

    std::FILE *get() const
    {
        return file_;
    }
    void finish()
    {
        const bool bad = file_ && (std::ferror(file_) != 0 || std::fflush(file_) != 0);
        if (bad) {
            throw std::runtime_error(path_ + ": cannot be written: " + std::strerror(errno));
        }
    }

  private:
    std::FILE *open()
    {
        std::FILE *file = std::fopen(path_.c_str(), "w");
        if (!file) {
            throw std::runtime_error(path_ + ": " + std::strerror(errno));
        }
        return file;
    }

    std::string path_;
    std::FILE *file_;
};

} // namespace sim

#endif
