package skein.scenario

import skein.formula.{Evaluation, Node}
import skein.policy.PolicyGraph
import skein.units.{Metres, MetresPerSecond}

/** A scenario as a file of data, without code; `docs/scenario-file.md` defines its lines. The nodes of
  * vehicles, limits and windows depend only on settings.
  *
  * @param text the text of the whole file
  * @param over the condition that ends the flight, which depends on positions, velocities and ages
  */
private[skein] final class ScenarioFile private[scenario] (
    val text: String,
    val name: String,
    val note: String,
    val scene: String,
    val settings: Vector[ScenarioFile.Setting],
    val durationS: Option[Node],
    val vehicles: Vector[ScenarioFile.Vehicle],
    val limits: Vector[ScenarioFile.Bounded],
    val series: Vector[ScenarioFile.Drawn],
    val over: Option[Watched]
):
  private val fixed = (durationS ++ vehicles.flatMap(_.numbers) ++ limits.flatMap(_.numbers) ++
    series.flatMap(each =>
      each.bound.map(_._2) ++ each.measures.flatMap(_.window.map(_._2))
    )).toVector.distinct
  private val places     = fixed.zipWithIndex.toMap
  private val evaluation = Evaluation(fixed)

  /** The values of the nodes that depend only on settings. */
  private[scenario] def numbers(values: Array[Double]): Node => Double =
    val found = evaluation(Array.emptyDoubleArray, values)
    node => found(places(node))

private[skein] object ScenarioFile:
  val Version: Int = 1
  val Head: String = "skein-scenario"

  /** File ending by which a command distinguishes a scenario file from the name of a scenario. */
  val Suffix = ".scenario"

  /** The parameter of a recording that contains the file. */
  val Recorded = "scenarioFile"

  /** A setting, for the option `--set`.
    *
    * @param meaning one line for users
    */
  final case class Setting(name: String, default: Double, meaning: String)

  /** @param numbers nodes of its speed, m/s; its start north, east and down, m; and its heading, rad */
  private[scenario] final case class Vehicle(
      name: String,
      role: String,
      numbers: Vector[Node],
      policy: PolicyGraph
  )

  /** A kind of limits.
    *
    * @param count number of its parameters; 0 for any number of corners
    */
  private[scenario] enum LimitKind(val word: String, val count: Int, val of: Vector[Double] => Limit):
    case Separation extends LimitKind("separation", 1, of => Limit.separation(Metres(of(0))))
    case Horizontal
        extends LimitKind("horizontal-separation", 1, of => Limit.horizontalSeparation(Metres(of(0))))
    case Floor   extends LimitKind("floor", 1, of => Limit.floor(Metres(of(0))))
    case Ceiling extends LimitKind("ceiling", 1, of => Limit.ceiling(Metres(of(0))))
    case Speed   extends LimitKind("speed", 1, of => Limit.speed(MetresPerSecond(of(0))))
    case Circle
        extends LimitKind("circle", 3, of => Limit.geofence(Metres(of(0)), Metres(of(1)), Metres(of(2))))
    case Polygon extends LimitKind("polygon", 0, of => Limit.geofence(corners(of)))

  private def corners(of: Vector[Double]) =
    of.grouped(2).map(corner => (Metres(corner(0)), Metres(corner(1)))).toVector

  /** A limit of this kind, with the kind's parameters. */
  private[scenario] final case class Bounded(kind: LimitKind, numbers: Vector[Node])

  /** A quantity over time.
    *
    * @param graph the quantity as a function of only positions, which searches can optimise; None if it needs
    *   more
    */
  private[scenario] final case class Drawn(
      name: String,
      unit: String,
      watched: Watched,
      graph: Option[QuantityGraph],
      bound: Option[(String, Node)],
      measures: Vector[Reduced]
  )

  /** @param window `last` or `after`, with the number of seconds */
  private[scenario] final case class Reduced(
      name: String,
      reduction: Reduction,
      window: Option[(String, Node)]
  )
