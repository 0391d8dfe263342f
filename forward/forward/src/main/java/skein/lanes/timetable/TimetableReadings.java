package skein.lanes.timetable;

import skein.lanes.policy.LanePolicy;

/** The readings of one vehicle in many worlds, and what is predicted from them: by slot, then by world. */
public abstract class TimetableReadings {
  public static final int WORLDS = LanePolicy.WORLDS;

  /** Positions, m, and velocities, m/s, north and east. */
  public float[] seenX = {}, seenY = {}, seenVx = {}, seenVy = {};

  /** Positions and velocities down; empty where vehicles fly level. */
  public float[] seenZ = {}, seenVz = {};
}
