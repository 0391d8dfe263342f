package skein.lanes.loop;

import java.util.Arrays;
import skein.forecast.Forecast;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;

/**
 * What is known of vehicles in many worlds from their readings and from the commands sent to them, and where
 * they will be. The scalar reference is {@link Forecast}, whose clocks are one here.
 */
public final class LaneForecast {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final MeanDelays delays = new MeanDelays();
  private final ForecastTrack[] tracks;

  // By vehicle: by what it is carried forward, and what is read of it.
  private final ForecastVehicles[] vehicles;
  private final LaneVehicles[] read;

  /** By vehicle, for the decider asked for last: as {@link ForecastVehicles#predict} puts it. */
  private final float[][] predicted;

  /** Now, and in which ways were laid. */
  private int row, laidRow;

  /** The moments asked for last. */
  private final int[] predictedFor = new int[WORLDS];

  /** What came until then is known in a period's decisions, from its begin. */
  final int dueGrains;

  private final int[] due = new int[WORLDS];

  /**
   * @param deadTimeS from a command's arrival until a vehicle is taken to follow it
   */
  LaneForecast(double periodS, int count, double deadTimeS) {
    dueGrains = LaneViews.grains(periodS) / 2;
    Arrays.fill(due, dueGrains);
    tracks = new ForecastTrack[count];
    for (int v = 0; v < count; v++) tracks[v] = new ForecastTrack(periodS, deadTimeS);
    vehicles = new ForecastVehicles[count];
    read = new LaneVehicles[count];
    predicted = new float[count][LaneObservation.READ * WORLDS];
  }

  /** By what a vehicle is carried forward, and what is read of it. */
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

  /** To a period; they are taken in turn. */
  void startRow(int number) {
    row = number;
    for (ForecastTrack track : tracks) track.startRow(row);
  }

  /**
   * Takes what was read: of each world one reading at most, received no earlier than the one before.
   *
   * @param whose the number of the vehicle, or -1 for none
   * @param asked when it was asked for, made and received, from the row's begin
   */
  void enter(LaneVectors vectors, int[] whose, int[] asked, int[] made, int[] received) {
    for (int v = 0; v < tracks.length; v++)
      tracks[v].arrived.take(vectors, whose, v, asked, made, received, delays);
  }

  /**
   * Tells where all vehicles are known, when everything has entered that is known in a period's decisions.
   *
   * @param joinedAt becomes {@link #dueGrains} where they are, elsewhere {@link LaneOffers#NONE}
   * @param madeAt by vehicle, when a reading that is fresh was made, from the row's begin
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

  /**
   * Carries the newest readings to where the vehicles will be when a command acts that is sent at a moment.
   *
   * @param when by world, from the row's begin; {@link LaneOffers#NONE} where it is not decided
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

  /** What was predicted last of a vehicle: {@link LaneObservation#X} and so on, by world. */
  float[] predicted(int vehicle) {
    return predicted[vehicle];
  }

  /** How old its reading is at the moment that was predicted for, s. */
  public float[] age(int vehicle) {
    return tracks[vehicle].ageS;
  }

  /** How long it takes until a command acts, s. */
  public float[] actsS() {
    return delays.toS;
  }

  /**
   * Notes the commands of a period.
   *
   * @param times when each is sent, from the row's begin; {@link LaneOffers#NONE} where none is
   * @param answers when it is known to have arrived
   */
  void send(int vehicle, LaneVectors vectors, int[] times, int[] answers, Directions directions) {
    tracks[vehicle].send(row, vectors, times, answers, directions);
  }
}
