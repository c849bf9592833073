#include "lab/merge/report.h"

#include <cstdio>
#include <map>

namespace merge
{

namespace
{

/* A piece of a drive: its scans in one frame. */
struct Piece {
    size_t scans = 0;
    int64_t first_us = 0;
};

std::map<uint32_t, Piece> pieces_of(const Drive &drive)
{
    std::map<uint32_t, Piece> pieces;
    for (const DriveScan &scan : drive.scans) {
        Piece &piece = pieces[scan.frame];
        piece.first_us = piece.scans == 0 ? scan.stamp_us : piece.first_us;
        piece.scans++;
    }
    return pieces;
}

} // namespace

bool report_drive(const Drive &drive, uint32_t frame)
{
    std::map<uint32_t, Piece> pieces = pieces_of(drive);
    if (2 * pieces[frame].scans <= drive.scans.size()) {
        std::fprintf(stderr,
                     "ale-merge: %s is not joined: it shows no place of the others, or only what is alike\n",
                     drive.name.c_str());
        return false;
    }
    pieces.erase(frame);
    for (const auto &[other, piece] : pieces) {
        std::fprintf(stderr, "ale-merge: %s: a piece of %zu scans, from %.1f s on, is not joined\n",
                     drive.name.c_str(), piece.scans,
                     static_cast<double>(piece.first_us - drive.scans.front().stamp_us) * 1e-6);
    }
    return true;
}

bool report(const std::vector<Drive> &drives, uint32_t frame)
{
    size_t joined = 0;
    for (const Drive &drive : drives) {
        joined += report_drive(drive, frame);
    }
    std::fprintf(stderr, "ale-merge: %zu of %zu drives are one map\n", joined, drives.size());
    return joined == drives.size();
}

} // namespace merge
