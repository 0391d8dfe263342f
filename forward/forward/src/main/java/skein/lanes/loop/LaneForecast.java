package skein.lanes.loop;

import java.util.Arrays;
import skein.forecast.Forecast;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;

/** What is known of vehicles in many worlds from their readings and commands, and predictions of their
 * states. The scalar reference is {@link Forecast}, with a single clock here.
 */
public final class LaneForecast {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final MeanDelays delays = new MeanDelays();
  private final ForecastTrack[] tracks;

  // By vehicle: by what it is carried forward, and what is read of it.
  private final ForecastVehicles[] vehicles;
  private final LaneVehicles[] read;

  /** By vehicle, predictions for the last requested decision, as {@link ForecastVehicles#predict} lays them
   * out.
   */
  private final float[][] predicted;

  private int row, laidRow;

  private final int[] predictedFor = new int[WORLDS];

  /** Deadline, from a period's start, of messages that its decisions consider. */
  final int dueGrains;

  private final int[] due = new int[WORLDS];

  /** @param deadTimeS from a command's arrival until a vehicle is assumed to follow it */
  LaneForecast(double periodS, int count, double deadTimeS) {
    dueGrains = LaneViews.grains(periodS) / 2;
    Arrays.fill(due, dueGrains);
    tracks = new ForecastTrack[count];
    for (int v = 0; v < count; v++) tracks[v] = new ForecastTrack(periodS, deadTimeS);
    vehicles = new ForecastVehicles[count];
    read = new LaneVehicles[count];
    predicted = new float[count][LaneObservation.READ * WORLDS];
  }

  /** Sets the model that predicts a vehicle, and the source of its readings. */
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
    for (ForecastTrack track : tracks) track.start();
    for (ForecastVehicles each : vehicles) each.start();
  }

  /** Moves to a period; periods are processed in order. */
  void startRow(int number) {
    row = number;
    for (ForecastTrack track : tracks) track.startRow(row);
  }

  /** Adds readings: one per world at most, received no earlier than those before.
   *
   * @param whose the number of the vehicle, or -1 for none
   * @param asked when it was requested, sampled and received, from the row's start
   */
  void enter(LaneVectors vectors, int[] whose, int[] asked, int[] made, int[] received) {
    for (int v = 0; v < tracks.length; v++)
      tracks[v].arrived.take(vectors, whose, v, asked, made, received, delays);
  }

  /** Reports the worlds in which all vehicles are known, after adding everything that a period's decisions
   * consider.
   *
   * @param joinedAt set to {@link #dueGrains} in those worlds, elsewhere to {@link LaneOffers#NONE}
   * @param madeAt by vehicle, when a fresh reading was sampled, from the row's start
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
    read.read(row, arrived.vectors, arrived.enters, arrived.madeAt(), arrived.enters, true);
    by.enter(arrived.vectors, track, arrived.enters, read.state);
  }

  /** Predicts the vehicles' states for the time at which a command sent at a moment takes effect.
   *
   * @param when by world, from the row's start; {@link LaneOffers#NONE} where there is no decision
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

  /** The last prediction of a vehicle: {@link LaneObservation#X} and so on, by world. */
  float[] predicted(int vehicle) {
    return predicted[vehicle];
  }

  /** Age of its reading at the predicted moment, s. */
  public float[] age(int vehicle) {
    return tracks[vehicle].ageS;
  }

  /** Time until a command takes effect, s. */
  public float[] actsS() {
    return delays.toS;
  }

  /** Records the commands of a period.
   *
   * @param times when each is sent, from the row's start; {@link LaneOffers#NONE} where none is
   * @param answers when its arrival becomes known
   */
  void send(int vehicle, LaneVectors vectors, int[] times, int[] answers, Directions directions) {
    tracks[vehicle].send(row, vectors, times, answers, directions);
  }
}
