#include "modeler/volume/doors.h"

const sgm::volume::Doors sgm_volume_doors{
    &sgm::volume::airOf,    &sgm::volume::dense,       &sgm::volume::fillVdb, &sgm::volume::fog,
    &sgm::volume::keepOnly, &sgm::volume::renormalize, &sgm::volume::sample};
