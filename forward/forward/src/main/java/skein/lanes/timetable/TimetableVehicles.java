package skein.lanes.timetable;

import skein.forward.RolloutAgent;
import skein.lanes.plant.LaneSensors;
import skein.lanes.policy.Directions;
import skein.lanes.policy.VehicleNumbers;
import skein.vehicle.SensorNoise;

/** The vehicles of one role in many worlds, simulated by a {@link Timetable}: events happen simultaneously in
 * all worlds, so all that depends only on time is a constant of the timetable, computed by a corresponding
 * {@link EventClock}.
 */
public abstract class TimetableVehicles extends TimetableReadings {
  /** Predicts from their readings, in loops that predict; else null. */
  public PredictedVehicles predicted;

  /** Start of each world's vehicle, north, east and down, m. */
  public final float[] startX = new float[WORLDS],
      startY = new float[WORLDS],
      startZ = new float[WORLDS];

  private final boolean inSpace;

  /** Errors of readings; null if these are true. */
  private LaneSensors sensors;

  public TimetableVehicles(RolloutAgent agent) {
    this(agent, false);
  }

  /** @param inSpace whether commands and readings have a vertical part */
  public TimetableVehicles(RolloutAgent agent, boolean inSpace) {
    this.inSpace = inSpace;
    for (int world = 0; world < WORLDS; world++) place(world, agent);
  }

  public final boolean inSpace() {
    return inSpace;
  }

  private void place(int world, RolloutAgent agent) {
    startX[world] = (float) agent.startX();
    startY[world] = (float) agent.startY();
    startZ[world] = (float) agent.altitudeDownM();
  }

  /** Sets where a world's vehicle starts in all later episodes. */
  public final void place(int world, VehicleNumbers numbers) {
    startX[world] = numbers.northM();
    startY[world] = numbers.eastM();
    startZ[world] = numbers.downM();
  }

  /** Resets to the start of an episode.
   *
   * @param readings number of slots that its timetable needs
   * @param worlds number of worlds that count, from the first
   */
  public final void start(int readings, int worlds) {
    if (seenX.length < readings * WORLDS) {
      seenX = new float[readings * WORLDS];
      seenY = new float[readings * WORLDS];
      seenVx = new float[readings * WORLDS];
      seenVy = new float[readings * WORLDS];
      if (inSpace) {
        seenZ = new float[readings * WORLDS];
        seenVz = new float[readings * WORLDS];
      }
    }
    start(worlds);
    if (predicted != null) predicted.start(worlds, startZ);
  }

  public abstract void start(int worlds);

  /** Restarts one world: sets its vehicle, and all its readings, to its start at rest.
   *
   * @param headingRad where a car points
   */
  public final void restart(int world, float headingRad) {
    for (int i = world; i < seenX.length; i += WORLDS) {
      seenX[i] = startX[world];
      seenY[i] = startY[world];
      seenVx[i] = 0f;
      seenVy[i] = 0f;
      if (inSpace) {
        seenZ[i] = startZ[world];
        seenVz[i] = 0f;
      }
    }
    if (predicted != null) predicted.restart(world, this);
    rest(world, headingRad);
  }

  /** Sets one world's vehicle to its start, at rest. */
  abstract void rest(int world, float headingRad);

  public final void senseBy(SensorNoise noise) {
    sensors = new LaneSensors(noise, inSpace);
  }

  /** Sets the seeds of the errors of the next episode's readings, if there are any.
   *
   * @param seeds by world
   * @param vehicle index of these vehicles
   */
  public final void seed(long[] seeds, int vehicle) {
    if (sensors != null) sensors.start(seeds, vehicle, true);
  }

  /** Adds the errors of a reading.
   *
   * @param atNs time of the reading
   * @param into the index, for the first world, of the reading
   */
  final void sense(long atNs, int into, boolean withVelocity) {
    sensors.at(atNs);
    sensors.add(LaneSensors.NORTH, seenX, into);
    sensors.add(LaneSensors.EAST, seenY, into);
    if (inSpace) sensors.add(LaneSensors.DOWN, seenZ, into);
    // In space, velocities are always read.
    if (!withVelocity && !inSpace) return;
    sensors.add(LaneSensors.NORTH_MPS, seenVx, into);
    sensors.add(LaneSensors.EAST_MPS, seenVy, into);
    if (inSpace) sensors.add(LaneSensors.DOWN_MPS, seenVz, into);
  }

  /** Reads the vehicles.
   *
   * @param times the clock's values for this moment, from {@code at} on
   * @param into the index, for the first world, of the reading
   * @param withVelocity whether velocities are read too
   */
  public abstract void look(float[] times, int at, int into, boolean withVelocity);

  /** Lets commands take effect from this moment on.
   *
   * @param from the index, for the first world, of the commanded direction
   */
  abstract void act(float[] times, int at, Directions commanded, int from);
}
