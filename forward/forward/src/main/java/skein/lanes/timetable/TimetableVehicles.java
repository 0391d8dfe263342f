package skein.lanes.timetable;

import skein.forward.RolloutAgent;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/**
 * The vehicles of one role in many worlds, flown by a {@link Timetable}: what happens to them
 * happens in all worlds at once, so that all that depends on time alone is a number of the
 * timetable, told by a {@link EventClock} of the same kind.
 */
public abstract class TimetableVehicles {
  public static final int WORLDS = LanePolicy.WORLDS;

  /** How the vehicles answered, by place: positions, m, and velocities, m/s, north and east. */
  public float[] seenX = {}, seenY = {}, seenVx = {}, seenVy = {};

  /** Carries their readings forward, in loops that predict; else null. */
  public PredictedVehicles predicted;

  /** Where each world's vehicle starts, north and east, m. */
  public final float[] startX = new float[WORLDS], startY = new float[WORLDS];

  public TimetableVehicles(RolloutAgent agent) {
    for (int world = 0; world < WORLDS; world++) place(world, agent);
  }

  /** A world's vehicle starts where this one does. */
  public final void place(int world, RolloutAgent agent) {
    startX[world] = (float) agent.startX();
    startY[world] = (float) agent.startY();
  }

  /**
   * Back to the start of an episode.
   *
   * @param readings places that its timetable needs
   * @param worlds those that count are the first
   */
  public final void start(int readings, int worlds) {
    if (seenX.length < readings * WORLDS) {
      seenX = new float[readings * WORLDS];
      seenY = new float[readings * WORLDS];
      seenVx = new float[readings * WORLDS];
      seenVy = new float[readings * WORLDS];
    }
    start(worlds);
    if (predicted != null) predicted.start(worlds);
  }

  public abstract void start(int worlds);

  /** One world's vehicle is at its start, at rest, and so tell all its readings. */
  public final void restart(int world) {
    for (int i = world; i < seenX.length; i += WORLDS) {
      seenX[i] = startX[world];
      seenY[i] = startY[world];
      seenVx[i] = 0f;
      seenVy[i] = 0f;
    }
    if (predicted != null) predicted.restart(world, seenX, seenY, seenVx, seenVy);
    rest(world);
  }

  /** Puts one world's vehicle to its start, at rest. */
  abstract void rest(int world);

  /**
   * Reads the vehicles.
   *
   * @param times from {@code at} on, what the clock tells of this moment
   * @param into the index of the reading's first world
   * @param withVelocity whether velocities are read too
   */
  public abstract void look(float[] times, int at, int into, boolean withVelocity);

  /**
   * Lets commands act from this moment on.
   *
   * @param from the index of the first world's commanded direction
   */
  abstract void act(float[] times, int at, Directions commanded, int from);
}
