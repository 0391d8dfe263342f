package skein.lanes.timetable

/** How the flights of a timetable may end before their duration. */
private[lanes] enum OwnEnds:
  case None

  /** By positions and velocities alone. */
  case ByPlace

  /** Also by the time or the ages of readings. */
  case ByTime
