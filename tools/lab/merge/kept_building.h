/* A building's map that is kept: the map file, and the folder FILE.d beside it with all that it was made of.
 *
 *   building.ale             the map of the newest version, as ale-slamd loads it
 *   building.ale.d/versions  versions and drives: versions.h
 *   .../0002.map  0002.png   a version's map, and a picture of what is not as in the one before
 *   .../0002.places.gz       where the scans of all drives lie; of the newest version alone
 *   .../0002.earlier.map     what drives have shown that are not kept; likewise
 *   .../drives/1c0d77e2.gz   the log of a drive that is kept, by its checksum; .ini: its configuration
 *
 * A version is there when `versions` names it: that file is replaced last, at once, and then the map. Whoever
 * is interrupted before has changed nothing; after it, the next merge puts the map in place. */
#ifndef ALE_LAB_MERGE_KEPT_BUILDING_H
#define ALE_LAB_MERGE_KEPT_BUILDING_H

#include <memory>
#include <string>
#include <vector>

#include "common/export/map_image.h"
#include "lab/merge/scan_places.h"
#include "lab/merge/versions.h"

namespace merge
{

/* A drive that comes with a version. */
struct NewDrive {
    KnownDrive known;
    std::string log;    /* its file */
    std::string config; /* likewise, or empty */
};

struct NextVersion {
    Version lengths; /* number, date and checksum are set here */
    std::vector<NewDrive> drives;
    ScanPlaces places; /* of all drives that are kept from now on */
    const ale_map_t *map;
    const ale_map_t *earlier; /* or nullptr */
    ale::MapScene picture;
};

class KeptBuilding
{
  public:
    /* Nothing is there yet, or a map with its folder; what an interrupted merge has left undone is done.
     * Throws std::runtime_error with one line: a map of other origin, a damaged file. */
    explicit KeptBuilding(const std::string &path);

    const History &history() const
    {
        return history_;
    }
    /* The drives that are kept, by date, where the newest version has them. */
    std::vector<Drive> read_drives() const;
    ScanPlaces places() const;
    /* Of the newest version, without walls before the first; what drives have shown that are not kept, or
     * none. */
    std::unique_ptr<ale_map_t> map() const;
    std::unique_ptr<ale_map_t> earlier() const;

    /* The next version, in place; drives whose places are not in it are kept no longer. Throws
     * std::runtime_error, also when another merge has come before. */
    void commit(const NextVersion &next);

    std::string picture() const; /* of the newest version */

  private:
    std::string file(uint32_t version, const char *ending) const;
    std::string log_file(uint32_t checksum, const char *ending) const;
    uint32_t newest() const
    {
        return history_.versions.empty() ? 0 : history_.versions.back().number;
    }
    void check_map() const;
    void put_in_place() const;
    void write_files(const NextVersion &next, uint32_t number) const;
    void remove_superseded() const;

    std::string path_;
    std::string folder_;
    History history_;
};

} // namespace merge

#endif
