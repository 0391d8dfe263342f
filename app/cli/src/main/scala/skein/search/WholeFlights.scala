package skein.search

import skein.flight.{InParallel, VirtualFlights}
import skein.forward.*
import skein.lanes.Engine
import skein.loop.LoopKind
import skein.optimise.{Objective, ScenarioTerm, ValueEvaluator}
import skein.scenario.{EndFormula, Measure, OwnEnd, Scenario, Track, Tracks, Window}
import skein.settings.{FlySettings, VehicleChoice}
import skein.signal.LatencyProfile
import skein.simd.WorldRandom
import skein.units.*
import skein.vehicle.VehicleKind

/** Simulates whole episodes of a scenario, one by one, for any policies and measures.
  *
  * @param vehicles the vehicle model, for people
  * @param model the vehicle model in one word
  * @param fly simulates an episode by its number, on the calling thread
  */
final class WholeFlights private (
    val vehicles: String,
    val model: String,
    val engine: Engine,
    val effort: Effort,
    val blockEpisodes: Int,
    durationS: Double,
    fly: (Scenario, Int) => Either[String, Tracks]
):
  /** An episode's objective value.
    *
    * @return Left says why the episode could not be completed
    */
  def value(scenario: Scenario, objective: Objective, episode: Int): Either[String, Double] =
    sum(scenario, objective, episode).map(_.getOrElse(objective.direction.sign * Objective.Never))

  /** The weighted sum of an episode's measures; None if one has no value.
    *
    * @return Left says why the episode could not be completed
    */
  def sum(scenario: Scenario, objective: Objective, episode: Int): Either[String, Option[Double]] =
    val measures = scenario.measures.map(measure => measure.name -> measure).toMap
    fly(scenario, episode).map: flown =>
      val values = objective.measures.flatMap: (weight, named) =>
        val measure = measures(named.name)
        measure.of(flown).orElse(ScenarioTerm.never(measure, durationS)).map(weight * _)
      Option.when(values.size == objective.measures.size)(values.sum)

  /** Number of episodes per second, for people. Simulates two to measure it. */
  def rate(scenario: Scenario, objective: Objective, threads: Int): String =
    def flown = value(scenario, objective, 0)
    val _     = flown
    val from  = System.nanoTime()
    val again = flown
    val rate  = threads / ((System.nanoTime() - from) * 1e-9)
    again.fold(
      identity,
      _ => if rate >= 1 then s"about ${rate.round} a second" else s"about one in ${(1 / rate).round} s"
    )

object WholeFlights:
  /** Maximum number of flights in virtual time in one search: a day of them, at one a second. */
  val MostVirtual = 100_000

  /** A scenario for forward simulation.
    *
    * @return Left says why it cannot be simulated
    */
  def engagement(scenario: Scenario, durationS: Double): Either[String, Engagement] =
    try Right(Engagement.ofScenario(scenario, durationS))
    catch case refused: IllegalArgumentException => Left(Expect.refused(refused))

  /** Why models of level flight do not support a scenario; `tilt` and `quadrotor` do then. */
  def climbs(flown: Engagement): Option[String] =
    flown.climbs.orElse:
      val altitudes = flown.agents.filter(_.kind != VehicleKind.Car).map(_.altitudeDownM)
      Option.when(altitudes.distinct.size > 1)("not all fly at one altitude")

  /** One episode by forward simulation.
    *
    * @return Left says why it cannot be simulated, or that not all vehicles were observed
    */
  private def simulate(conditions: Conditions.Resolved, link: Delays, seed: Long)(
      scenario: Scenario,
      episode: Int
  ): Either[String, Tracks] = engagement(scenario, conditions.game.durationS).flatMap: flown =>
    val agents  = scenario.agents
    val samples = agents.map(agent =>
      Vector.newBuilder[(Instant, Vector3)] += ((Instant.ofNanos(0), agent.startPositionNed))
    )
    val observer = new LoopObserver:
      override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
        samples(vehicle) += ((
          Instant.ofNanos(0) + Span.ofSeconds(timeS),
          Vector3(x, y, z)
        )): Unit
    Rollout(
      flown,
      conditions.timing,
      link,
      conditions.vehicle.response
    ).fly(WorldRandom.key(seed, 0, episode), observer = observer)
    Tracks
      .of(agents.zip(samples).map((agent, places) =>
        Track.ofPositions(agent.name, agent.role.name, places.result())
      ))
      .toRight("its vehicles were not all seen")

  /** One episode in virtual time, with the actual simulator, link, client and loop.
    *
    * @return Left says why it could not be completed
    */
  private def run(conditions: Conditions, loop: LoopKind, link: LatencyProfile, seed: Long)(
      scenario: Scenario,
      episode: Int
  ): Either[String, Tracks] =
    import conditions.{durationS, movesInFlight, periodMs}
    val (duration, period) = (Span.ofSeconds(durationS), Span.ofMillis(periodMs))
    conditions.noise.flatMap: noise =>
      VirtualFlights.result(FlySettings(
        List(loop),
        List(link),
        duration,
        period,
        seed + episode,
        scenario,
        movesInFlight = movesInFlight,
        sensors = noise
      )).map(_.tracks)

  /** Episodes by forward simulation, world by world.
    *
    * @param why no faster engine can be used
    */
  def scalar(flown: Conditions.Resolved, link: Delays, seed: Long, why: String): WholeFlights =
    WholeFlights(
      flown.vehicle.description,
      flown.vehicle.name,
      Engine.scalar(why),
      Effort.OfScalarFlights,
      blockEpisodes = 64,
      flown.game.durationS,
      simulate(flown, link, seed)
    )

  /** Why a scenario needs whole flights, world by world; None if its quantities suffice. */
  def whole(flown: Engagement, objective: Objective): Option[String] =
    def keysWhere(is: Measure => Boolean) = objective.measures.map(_._2).filter(is).map(ScenarioTerm.keyOf)
    val plain                             = keysWhere(_.parts.isEmpty)
    val partly                            = keysWhere(_.parts.exists(_.over.isInstanceOf[Window.Last]))
    val refused                           =
      flown.isOver.collect { case end: OwnEnd => EndFormula.of(end, flown.agents.size) }.flatMap(
        _.left.toOption
      )
    if plain.nonEmpty then
      Some(
        s"${plain.mkString(", ")} is of whole flights: expected a reduction of a quantity of positions and time"
      )
    else if refused.nonEmpty then refused.map(why => s"its end is no formula: ${why.getMessage}")
    else
      Option.when(flown.isOver.nonEmpty && partly.nonEmpty)(
        s"it says itself when it is over, and ${partly.mkString(", ")} is of the flight's last seconds"
      )

  /** The plant for a scenario.
    *
    * @param climbs why models of level flight do not support it
    * @param plant a user's, or the default
    */
  def plant(
      flown: Engagement,
      climbs: Option[String],
      plant: String,
      isTold: Boolean
  ): Either[String, String] =
    import VehicleChoice.{Spatial, Tilt}
    climbs match
      case None                                                     => Right(plant)
      case Some(_) if isTold && (plant == Spatial || plant == Tilt) => Right(plant)
      case Some(reason) if isTold => Left(s"--plant: expected $Tilt or $Spatial, got $plant: $reason")
      case Some(_)                => Right(if flown.isTraced then Tilt else Spatial)

  /** Episodes in virtual time.
    *
    * @param reason no faster engine can be used
    */
  def virtual(
      conditions: Conditions,
      loop: LoopKind,
      link: LatencyProfile,
      seed: Long,
      reason: String
  ): WholeFlights = WholeFlights(
    SimulatorsQuadrotor,
    "simulator",
    Engine(Engine.Kind.Flights, s"flights in virtual time: $reason"),
    Effort.OfFlights,
    blockEpisodes = 4,
    conditions.durationS,
    run(conditions, loop, link, seed)
  )

  /** The message that virtual flights take no plant.
    *
    * @param reason why no other engine can be used
    */
  def noPlant(reason: String): String =
    s"--plant: expected none, since this scenario flies in virtual time by $SimulatorsQuadrotor: $reason"

  /** The vehicle model of virtual flights, for people. */
  private val SimulatorsQuadrotor = "the simulator's quadrotor"

/** Evaluates candidates by whole flights.
  *
  * @param scenario makes a candidate's scenario
  */
final class WholeFlightEvaluator(
    flights: WholeFlights,
    scenario: Vector[Double] => Scenario,
    objective: Objective,
    threads: Int
) extends ValueEvaluator:

  /** @throws BlocksFailed if a flight could not be completed */
  def valuesUnless(isCancelled: () => Boolean)(
      candidates: Vector[Vector[Double]],
      episodes: Range
  ): Option[Vector[Array[Double]]] =
    val worlds = candidates.map(scenario).flatMap(flown => episodes.map((flown, _)))
    val came   = InParallel.map(worlds, threads): (flown, episode) =>
      Option.unless(isCancelled())(flights.value(flown, objective, episode))
    Option.when(came.forall(_.nonEmpty)):
      val values = came.flatten.map(_.fold(reason => throw BlocksFailed(reason), identity))
      values.grouped(episodes.size).map(_.toArray).toVector
