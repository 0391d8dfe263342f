package skein.scenario

import skein.formula.{Evaluation, Node}
import skein.policy.PolicyGraph

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

  /** A limit of this kind, with the kind's parameters. */
  private[scenario] final case class Bounded(kind: String, numbers: Vector[Node])

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
  private[scenario] final case class Reduced(name: String, reduction: String, window: Option[(String, Node)])
