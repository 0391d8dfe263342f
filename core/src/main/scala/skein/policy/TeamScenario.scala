package skein.policy

import java.util.Locale
import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.units.*

/** A scenario of more than two vehicles, all at one altitude, as its settings. */
sealed trait TeamScenario extends Product:

  /** How many vehicles fly. */
  def vehicles: Int

  def altitudeM: Double

  def name: String = productPrefix.toLowerCase(Locale.ROOT)

  /** Every setting by name, as [[TeamScenario.of]] reads it back. */
  def settings: Seq[(String, String)] = productElementNames.zip(productIterator.map(_.toString)).toSeq

  /** Who flies, and how. */
  def scenario: Fleet

  /** Every setting that cannot be flown. */
  def mistakes: Seq[String] =
    val count = Option.when(vehicles < fewest || vehicles > TeamScenario.Most)(
      s"vehicles: expected $fewest to ${TeamScenario.Most}, came $vehicles"
    )
    val measures = settings.collect:
      case (name, value) if !counts(name) && !isRight(name, value.toDouble) =>
        s"$name: expected more than 0, came $value"
    (count.toSeq ++ measures ++ ownMistakes).map(mistake => s"$name.$mistake")

  private def isRight(name: String, value: Double) = value > 0 || value == 0 && mayBeZero(name)

  /** Vehicles without which there is nothing to see. */
  protected def fewest: Int = 2

  /** Settings that count; all others measure something. */
  protected def counts: Set[String] = Set("vehicles")

  /** Measures that may be 0; all others must be more. */
  protected def mayBeZero: Set[String] = Set.empty

  /** What else cannot be flown. */
  protected def ownMistakes: Seq[String] = Seq.empty

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
  ) extends TeamScenario:
    override protected def fewest: Int = 3

    def scenario: Fleet =
      val evader   = agent("Evader", Role.Evader, evaderMps, startM, 0, altitudeM, 0, Flee(evaderMps))
      val policy   = Surrounding(0, ringM, pursuerMps)
      val pursuers = Vector.tabulate(vehicles - 1): pursuer =>
        val eastM = (pursuer - (vehicles - 2) / 2.0) * ringM / 2
        agent(s"Pursuer${pursuer + 1}", Role.Pursuer, pursuerMps, 0, eastM, altitudeM, 0, policy)
      Fleet(evader +: pursuers)

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
  ) extends TeamScenario:
    override protected def mayBeZero: Set[String] = Set("straightM", "lagS")

    def circuit: Racetrack = Racetrack(straightM, radiusM)

    /** Where slots are in the leader's frame: metres ahead and to the right, by follower. */
    def slots: Vector[(Double, Double)] =
      Vector.tabulate(vehicles - 1): follower =>
        val rank = follower / 2 + 1
        val side = if follower % 2 == 0 then 1 else -1
        (-rank * spacingM, side * rank * spacingM)

    def scenario: Fleet =
      val leading   = LeadOnCircuit(circuit, leaderMps, leaderMps * lagS)
      val leader    = agent("Leader", Role.Leader, leaderMps, 0, 0, altitudeM, 0, leading)
      val followers = slots.zipWithIndex.map:
        case ((aheadM, rightM), follower) =>
          val policy = KeepSlot(0, circuit, aheadM, rightM, mostMps, lagS)
          agent(s"Follower${follower + 1}", Role.Follower, leaderMps, aheadM, rightM, altitudeM, 0, policy)
      Fleet(leader +: followers)

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
  ) extends TeamScenario:
    override protected def counts: Set[String]      = Set("vehicles", "streams")
    override protected def mayBeZero: Set[String]   = Set("laneM", "marginM")
    override protected def ownMistakes: Seq[String] =
      Option.when(streams != 2 && streams != 4)(s"streams: expected 2 or 4, came $streams").toSeq

    /** Where the vehicles want to be, north and east, m. */
    def goals: Vector[(Double, Double)] = routes.map(route => onLane(route.headingRad, route.goalM))

    def scenario: Fleet =
      Fleet(routes.zipWithIndex.map: (route, vehicle) =>
        val (northM, eastM)         = onLane(route.headingRad, route.startM)
        val (goalNorthM, goalEastM) = onLane(route.headingRad, route.goalM)
        val policy = Avoidance(goalNorthM, goalEastM, cruiseMps, mostMps, minimumM, marginM, horizonS)
        val name   = s"Vehicle${vehicle + 1}"
        agent(name, Role.Traveller, cruiseMps, northM, eastM, altitudeM, route.headingRad, policy))

    /** By vehicle: the streams take vehicles in turn, and those of a stream fly one behind the other. The first of a
      * stream flies furthest, so that all fly equally far and nobody waits in another's way.
      */
    private def routes: Vector[Route] =
      Vector.tabulate(vehicles): vehicle =>
        val (stream, rank) = (vehicle % streams, vehicle / streams)
        val lastRank       = (vehicles - 1 - stream) / streams
        Route(
          headingRad = stream * math.Pi / 2,
          startM = -(entryM + rank * spacingM),
          goalM = entryM + (lastRank - rank) * spacingM
        )

    private def onLane(headingRad: Double, alongM: Double): (Double, Double) =
      val (cos, sin) = (StrictMath.cos(headingRad), StrictMath.sin(headingRad))
      (alongM * cos - laneM * sin, alongM * sin + laneM * cos)

  /** Places along the heading, from the middle of the crossing, m. */
  private final case class Route(headingRad: Double, startM: Double, goalM: Double)

  /** Vehicles. */
  val Most = 100

  val names: Seq[String] = Seq("surround", "formation", "crossing")

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
