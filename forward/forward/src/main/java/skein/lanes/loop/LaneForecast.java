package skein.lanes.loop;

import java.util.Arrays;
import skein.forecast.Forecast;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;

/** Predicts the states of vehicles in many worlds from their readings and commands. The scalar reference is
 * {@link Forecast}; here there is a single clock.
 */
public final class LaneForecast {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final MeanDelays delays = new MeanDelays();
  private final ForecastTrack[] tracks;

  // By vehicle: its predictor, and the vehicles that its readings come from.
  private final ForecastVehicles[] vehicles;
  private final LaneVehicles[] read;

  /** The predictions for the last decision, indexed by vehicle, in the layout of {@link
   * ForecastVehicles#predict}.
   */
  private final float[][] predicted;

  private int row, laidRow;

  private final int[] predictedFor = new int[WORLDS];

  /** Time at which decisions are due; later messages are ignored. In grains from the period's start. */
  final int dueGrains;

  private final int[] due = new int[WORLDS];

  /** @param deadTimesS by vehicle, from the arrival of a command until it is assumed to follow it, s
   * @param inSpace whether climbs are predicted
   */
  LaneForecast(double periodS, double[] deadTimesS, boolean inSpace) {
    int count = deadTimesS.length;
    dueGrains = LaneViews.grains(periodS) / 2;
    Arrays.fill(due, dueGrains);
    tracks = new ForecastTrack[count];
    for (int v = 0; v < count; v++) tracks[v] = new ForecastTrack(periodS, deadTimesS[v], inSpace);
    vehicles = new ForecastVehicles[count];
    read = new LaneVehicles[count];
    predicted = new float[count][LaneObservation.count(true, inSpace) * WORLDS];
  }

  /** Sets the model that predicts a vehicle, and the vehicles that its readings come from. */
  void follow(int vehicle, ForecastVehicles by, LaneVehicles read) {
    vehicles[vehicle] = by;
    this.read[vehicle] = read;
  }

  ForecastTrack track(int vehicle) {
    return tracks[vehicle];
  }

  void start() {
    delays.start();
    laidRow = -1;
    for (int v = 0; v < tracks.length; v++) {
      tracks[v].start(read[v].startZ);
      vehicles[v].start(read[v].startZ);
    }
  }

  /** Moves to a period; periods are processed in order. */
  void startRow(int number) {
    row = number;
    for (ForecastTrack track : tracks) track.startRow(row);
  }

  /** Adds readings, at most one per world. In each world, readings must be added in the order of arrival.
   *
   * @param whose index of the vehicle that was read, or -1 in worlds without a reading
   * @param asked time of the request; {@code made} of the sample, {@code received} of the answer: in grains
   *   from the period's start
   */
  void enter(LaneVectors vectors, int[] whose, int[] asked, int[] made, int[] received) {
    for (int v = 0; v < tracks.length; v++)
      tracks[v].arrived.take(vectors, whose, v, asked, made, received, delays);
  }

  /** Updates the forecast with the readings of a period, after the last {@link #enter} of that period.
   *
   * @param joinedAt set to {@link #dueGrains} in worlds where all vehicles have been read, else to {@link
   *   LaneOffers#NONE}
   * @param madeAt receives the sampling time of each vehicle's newest reading, in grains from the period's
   *   start
   */
  void tell(int[] joinedAt, int[][] madeAt) {
    Arrays.fill(joinedAt, dueGrains);
    for (int v = 0; v < tracks.length; v++) {
      while (tracks[v].layToReading(row)) {
        if (vehicles[v].remembers()) enter(tracks[v], vehicles[v], read[v]);
        tracks[v].conclude(row);
      }
      tracks[v].tell(joinedAt, madeAt[v]);
    }
  }

  private void enter(ForecastTrack track, ForecastVehicles by, LaneVehicles read) {
    ArrivedReadings arrived = track.arrived;
    read.sense(row, arrived.vectors, arrived.enters, arrived.madeAt(), arrived.enters, true);
    if (read.isSensed() && track.rest(read.state)) by.rest(track.first, track.restZ);
    by.enter(arrived.vectors, track, arrived.enters, read.state);
  }

  /** Predicts the vehicles' states at the time at which a command takes effect.
   *
   * @param when time at which the command is sent, in grains from the period's start; {@link LaneOffers#NONE}
   *   in worlds without a decision
   */
  void predict(LaneVectors vectors, int[] when) {
    boolean isFirst = laidRow < row;
    if (!isFirst && Arrays.equals(when, predictedFor)) return;
    laidRow = row;
    System.arraycopy(when, 0, predictedFor, 0, WORLDS);
    for (int v = 0; v < tracks.length; v++) {
      tracks[v].lay(row, vectors, due, when, delays, isFirst);
      vehicles[v].predict(vectors, tracks[v], read[v].state, predicted[v]);
    }
  }

  /** The last prediction of a vehicle, in the order of {@link LaneObservation#X} and the following constants.
   */
  float[] predicted(int vehicle) {
    return predicted[vehicle];
  }

  /** Age of the vehicle's newest reading at the time of the decision, s. */
  public float[] age(int vehicle) {
    return tracks[vehicle].ageS;
  }

  /** Expected time from the sending of a command until it takes effect, without the dead time, s. */
  public float[] actsS() {
    return delays.toS;
  }

  /** Records the commands of a period.
   *
   * @param times time of sending, in grains from the period's start; {@link LaneOffers#NONE} in worlds
   *   without a command
   * @param answers time at which the answer arrives, likewise
   */
  void send(int vehicle, LaneVectors vectors, int[] times, int[] answers, Directions directions) {
    tracks[vehicle].send(row, vectors, times, answers, directions);
  }
}
