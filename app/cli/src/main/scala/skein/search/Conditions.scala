package skein.search

import skein.forward.{Delays, Engagement, LoopTiming, VelocityResponse}
import skein.lanes.{Accelerator, TeamBatch}
import skein.loop.{LoopKind, LoopSettings, LoopTimings}
import skein.pickle.Fields
import skein.policy.Role
import skein.port.Moves
import skein.scenario.{PaperDuel, Scenario, Scenarios}
import skein.settings.{FlySettings, LinkText, SensorFile, VehicleChoice}
import skein.units.{Decimals, Expect, Span}
import skein.vehicle.{SensorNoise, VehicleKind}

/** Conditions of forward simulation for evaluating candidates, in the user's terms.
  *
  * @param plant see [[VehicleChoice.parse]]
  * @param eye a file of [[SensorFile]]: the pursuer observes the evader only through this sensor
  * @param movesInFlight maximum number of one vehicle's unanswered moves
  * @param sensors see [[SensorNoise.parse]]; without it readings are true
  */
final case class Conditions(
    loop: String,
    plant: String,
    periodMs: Double,
    durationS: Double,
    altitudeM: Double = PaperDuel.AltitudeM,
    eye: Option[String] = None,
    movesInFlight: Int = Moves.InFlight,
    sensors: Option[String] = None
):

  def loopText: String =
    if movesInFlight == Moves.InFlight || loop == LoopKind.Paused.label then loop
    else s"$loop with ${Decimals.counted(movesInFlight, "move")} in flight"

  /** @return the loop, or Left with what was expected and what was given */
  def checked: Either[String, LoopKind] =
    for
      kind <- LoopKind.parse(loop).left.map("--loop: " + _)
      _    <- Expect.that(altitudeM > 0 && altitudeM <= FlySettings.MostAltitudeM):
        s"--altitude: expected more than 0 and up to ${FlySettings.MostAltitudeM} m, got $altitudeM"
      _ <- Expect.that(periodMs >= 1 && periodMs <= 10_000):
        s"--period: expected 1 ms to 10 s, got $periodMs ms"
      _ <- Expect.that(durationS >= 10 && durationS <= 3600):
        s"--duration: expected 10 s to an hour, since the last 10 s are judged, got $durationS s"
      _ <- Moves.mistake(movesInFlight).map("--moves-in-flight: " + _).toLeft(())
    yield kind

  /** Errors of readings; Left says what was expected. */
  def noise: Either[String, Option[SensorNoise]] =
    Expect.each(sensors)(SensorNoise.parse).map(_.headOption).left.map("--sensors: " + _)

  /** Number of episodes over which the paused loop is averaged, of these: it has no delays, and differs from
    * episode to episode only by errors of readings.
    */
  def pausedEpisodes(episodes: Int): Int = if sensors.isEmpty then 1 else episodes

  /** @return Left says what was expected and what was given */
  def resolved(using Scenarios): Either[String, Conditions.Resolved] =
    for
      kind  <- checked
      known <- VehicleChoice.parse(plant, altitudeM).left.map("--plant: " + _)
      noise <- this.noise
      vehicle = known.sensedBy(noise)
      timing <- Conditions
        .timing(kind, Span.ofMillis(periodMs), movesInFlight, vehicle.response)
        .left.map("--loop: " + _)
      sensor <- Expect.optional(eye)(SensorFile.read(_)).left.map("--eye: " + _)
      game = Engagement.of(PaperDuel(altitudeM = altitudeM).fleet, durationS)
    yield Conditions.Resolved(timing, vehicle, game.seeing(Role.Pursuer, sensor))

object Conditions:
  given Fields[Conditions] = Fields.derived[Conditions].renamed("plant", "model")

  /** Altitude at which a scenario's first multirotor starts, m. Cars alone have the duel's, for models that
    * no vehicle flies by.
    */
  def altitudeM(scenario: Scenario): Double =
    scenario.agents.find(_.kind != VehicleKind.Car).fold(PaperDuel.AltitudeM)(-_.startPositionNed.z)

  /** @param game the paper's, in which policies of families are evaluated */
  final case class Resolved(timing: LoopTiming, vehicle: VehicleChoice, game: Engagement):
    def batch(threads: Int, accelerator: Option[Accelerator] = None): TeamBatch =
      TeamBatch(timing, vehicle.response, threads, accelerator)

    /** The scalar reference engine, on one thread. */
    def reference: TeamBatch = TeamBatch(timing, vehicle.response, threads = 1, isReference = true)

    /** The delays of a link between the controller and this number of vehicles.
      *
      * @return Left says what was expected and what was given
      */
    def delays(link: String, vehicles: Int): Either[String, Delays] =
      LinkText.delays(link, timing, vehicles)

    /** Whether the pursuer observes the evader only through a sensor. */
    def sees: Boolean = game.agents.exists(_.eye.isDefined)

    /** The ground truth with these vehicles and this period: a world that stands still while the controller
      * decides, and a pursuer that knows the evader's state.
      */
    def paused: Resolved =
      copy(
        timing = LoopTiming.Paused(timing.periodS),
        game = game.seeing(Role.Pursuer, None)
      )

  /** The loop's timing in `./skein fly`. A loop that predicts uses the best model of the vehicles. */
  private def timing(
      loop: LoopKind,
      period: Span,
      movesInFlight: Int,
      vehicles: VelocityResponse
  ): Either[String, LoopTiming] =
    val settings =
      LoopSettings.every(period).copy(model = _ => vehicles.predictor, movesInFlight = movesInFlight)
    LoopTimings
      .of(loop, settings)
      .toRight(
        s"forward simulation has no ${loop.label} loop; expected " +
          "paused, sequential, futures, stream or predictive"
      )
