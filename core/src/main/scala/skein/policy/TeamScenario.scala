package skein.policy

import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.units.*

/** A scenario of more than two vehicles, all at one altitude, as its settings. */
sealed trait TeamScenario extends Product:

  /** How many vehicles fly. */
  def vehicles: Int

  def altitudeM: Double

  def name: String = productPrefix.toLowerCase

  /** Every setting by name, as [[TeamScenario.of]] reads it back. */
  def settings: Seq[(String, String)] = productElementNames.zip(productIterator.map(_.toString)).toSeq

  /** Every setting that cannot be flown. */
  def mistakes: Seq[String] =
    val least     = if this.isInstanceOf[TeamScenario.Surround] then 3 else 2
    val distances = settings.filter((name, _) => name != "vehicles" && name != "streams")
    val common    = Seq(
      Option.when(vehicles < least || vehicles > TeamScenario.Most)(
        s"vehicles: expected $least to ${TeamScenario.Most}, came $vehicles"
      )
    ) ++ distances.map((name, value) =>
      Option.when(!(value.toDouble > 0) && !(TeamScenario.MayBeZero(name) && value.toDouble == 0))(
        s"$name: expected more than 0, came $value"
      )
    )
    val streams = this match
      case crossing: TeamScenario.Crossing if crossing.streams != 2 && crossing.streams != 4 =>
        Some(s"streams: expected 2 or 4, came ${crossing.streams}")
      case _ => None
    (common :+ streams).flatten.map(mistake => s"$name.$mistake")

  def scenario: Scenario = this match
    case surround: TeamScenario.Surround   => TeamScenario.surround(surround)
    case formation: TeamScenario.Formation => TeamScenario.formation(formation)
    case crossing: TeamScenario.Crossing   => TeamScenario.crossing(crossing)

object TeamScenario:

  /** Pursuers close a ring around an evader, which flees from the nearest of them.
    *
    * @param vehicles
    *   the evader included
    * @param ringM
    *   radius of the ring
    */
  final case class Surround(
      vehicles: Int = 6,
      ringM: Double = 8,
      pursuerMps: Double = 8,
      evaderMps: Double = 4,
      startM: Double = 30,
      altitudeM: Double = 5
  ) extends TeamScenario

  /** A wedge flies a circuit, the leader first, followers behind it to the left and right in turn.
    *
    * @param vehicles
    *   the leader included
    * @param spacingM
    *   of the slots, backwards and sideways
    * @param straightM
    *   of the circuit; its half turns have the radius `radiusM`
    * @param mostMps
    *   the fastest a follower is commanded
    * @param lagS
    *   time constant with which vehicles follow their commands; AirSim's at low altitude take about 1.5 s
    */
  final case class Formation(
      vehicles: Int = 5,
      spacingM: Double = 4,
      leaderMps: Double = 5,
      mostMps: Double = 10,
      straightM: Double = 50,
      radiusM: Double = 20,
      lagS: Double = 1.5,
      altitudeM: Double = 5
  ) extends TeamScenario

  /** Streams of vehicles cross at right angles, each vehicle on its way to a goal beyond the crossing.
    *
    * @param streams
    *   2, northward and eastward; or 4
    * @param spacingM
    *   between two vehicles of a stream
    * @param entryM
    *   from the first vehicle of a stream to the middle of the crossing
    * @param laneM
    *   by which each stream keeps to the right of the middle
    * @param minimumM
    *   the separation that is set
    * @param marginM
    *   kept on top of it by the avoidance rule, which does not know that vehicles lag behind their commands
    * @param horizonS
    *   of the avoidance rule
    */
  final case class Crossing(
      vehicles: Int = 20,
      streams: Int = 4,
      spacingM: Double = 6,
      entryM: Double = 25,
      laneM: Double = 4,
      cruiseMps: Double = 8,
      mostMps: Double = 10,
      minimumM: Double = 2,
      marginM: Double = 1,
      horizonS: Double = 3,
      altitudeM: Double = 5
  ) extends TeamScenario

  /** Vehicles. */
  val Most = 100

  val names: Seq[String] = Seq("surround", "formation", "crossing")

  private val MayBeZero = Set("laneM", "marginM", "straightM", "lagS")

  /** Reads settings back.
    *
    * @return
    *   or what is missing, or is no number
    */
  def of(name: String, settings: Map[String, String]): Either[String, TeamScenario] = name match
    case "surround"  => read[Surround](settings)
    case "formation" => read[Formation](settings)
    case "crossing"  => read[Crossing](settings)
    case other       => Left(s"no scenario '$other': expected one of ${names.mkString(", ")}")

  /** Where slots of a formation are in the leader's frame: metres ahead and to the right, by follower. */
  def slots(formation: Formation): Vector[(Double, Double)] =
    Vector.tabulate(formation.vehicles - 1): follower =>
      val rank = follower / 2 + 1
      val side = if follower % 2 == 0 then 1 else -1
      (-rank * formation.spacingM, side * rank * formation.spacingM)

  def circuit(formation: Formation): Racetrack = Racetrack(formation.straightM, formation.radiusM)

  /** Where the vehicles of a crossing want to be, north and east, m. */
  def goals(crossing: Crossing): Vector[(Double, Double)] =
    routes(crossing).map((headingRad, _, goalM) => onLane(crossing, headingRad, goalM))

  private def surround(settings: Surround): Scenario =
    val evader = agent(
      "Evader",
      Role.Evader,
      settings.evaderMps,
      settings.startM,
      0,
      settings.altitudeM,
      0,
      Flee(settings.evaderMps)
    )
    val policy   = Surrounding(0, settings.ringM, settings.pursuerMps)
    val pursuers = settings.vehicles - 1
    Scenario(evader +: Vector.tabulate(pursuers): pursuer =>
      val east = (pursuer - (pursuers - 1) / 2.0) * settings.ringM / 2
      agent(
        s"Pursuer${pursuer + 1}",
        Role.Pursuer,
        settings.pursuerMps,
        0,
        east,
        settings.altitudeM,
        0,
        policy
      ))

  private def formation(settings: Formation): Scenario =
    val track  = circuit(settings)
    val ahead  = settings.leaderMps * settings.lagS
    val leader = agent(
      "Leader",
      Role.Leader,
      settings.leaderMps,
      0,
      0,
      settings.altitudeM,
      0,
      LeadOnCircuit(track, settings.leaderMps, ahead)
    )
    Scenario(leader +: slots(settings).zipWithIndex.map: (slot, follower) =>
      val policy = KeepSlot(0, track, slot._1, slot._2, settings.mostMps, settings.lagS)
      agent(
        s"Follower${follower + 1}",
        Role.Follower,
        settings.leaderMps,
        slot._1,
        slot._2,
        settings.altitudeM,
        0,
        policy
      ))

  private def crossing(settings: Crossing): Scenario =
    val lanes = routes(settings)
    Scenario(lanes.zip(goals(settings)).zipWithIndex.map:
      case (((headingRad, startM, _), goal), vehicle) =>
        val (north, east) = onLane(settings, headingRad, startM)
        val policy        = Avoidance(
          goal._1,
          goal._2,
          settings.cruiseMps,
          settings.mostMps,
          settings.minimumM,
          settings.marginM,
          settings.horizonS
        )
        agent(
          s"Vehicle${vehicle + 1}",
          Role.Traveller,
          settings.cruiseMps,
          north,
          east,
          settings.altitudeM,
          headingRad,
          policy
        ))

  /** Heading, start and goal along it from the middle, m, by vehicle. The first of a stream flies furthest, so that all
    * fly equally far and nobody waits in another's way.
    */
  private def routes(crossing: Crossing): Vector[(Double, Double, Double)] =
    Vector.tabulate(crossing.vehicles): vehicle =>
      val (stream, rank) = (vehicle % crossing.streams, vehicle / crossing.streams)
      val last           = (crossing.vehicles - 1 - stream) / crossing.streams
      (
        stream * math.Pi / 2,
        -(crossing.entryM + rank * crossing.spacingM),
        crossing.entryM + (last - rank) * crossing.spacingM
      )

  private def onLane(crossing: Crossing, headingRad: Double, alongM: Double): (Double, Double) =
    val (cos, sin) = (StrictMath.cos(headingRad), StrictMath.sin(headingRad))
    (alongM * cos - crossing.laneM * sin, alongM * sin + crossing.laneM * cos)

  private def agent(
      name: String,
      role: Role,
      speedMps: Double,
      northM: Double,
      eastM: Double,
      altitudeM: Double,
      headingRad: Double,
      policy: TeamPolicy
  ): Agent =
    Agent(
      name,
      role,
      MetresPerSecond(speedMps),
      Vector3(northM, eastM, -altitudeM),
      Radians(headingRad),
      policy
    )

  private inline def read[A <: TeamScenario](settings: Map[String, String])(using
      mirror: Mirror.ProductOf[A]
  ): Either[String, A] =
    val names   = constValueTuple[mirror.MirroredElemLabels].toList.map(_.toString)
    val numbers = summonAll[Tuple.Map[mirror.MirroredElemTypes, Number]].toList.asInstanceOf[List[Number[?]]]
    val (wrong, right) = names
      .zip(numbers)
      .partitionMap((name, number) =>
        settings.get(name) match
          case None       => Left(s"no setting '$name'")
          case Some(text) =>
            number.read(text).toRight(s"setting '$name': expected ${number.what}, came '$text'")
      )
    Either.cond(wrong.isEmpty, mirror.fromProduct(Tuple.fromArray(right.toArray)), wrong.mkString("; "))

  private[policy] final class Number[A](val what: String, val read: String => Option[A])
  private[policy] given Number[Int]    = Number("a whole number", _.toIntOption)
  private[policy] given Number[Double] = Number("a number", _.toDoubleOption)
