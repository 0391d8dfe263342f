package skein.scenario

import scala.deriving.Mirror
import skein.policy.{Agent, GraphPolicy, Role}
import skein.units.*

/** A scenario from a [[ScenarioFile]], with values of its settings. */
private[skein] sealed class FileScenario(val file: ScenarioFile, val values: Array[Double]) extends Scenario:
  private lazy val number = file.numbers(values)

  def productArity: Int                               = file.settings.size
  def productElement(place: Int): Any                 = values(place)
  override def productElementName(place: Int): String = file.settings(place).name
  override def productPrefix: String                  = file.name
  def canEqual(other: Any): Boolean                   = other.isInstanceOf[FileScenario]

  override def equals(other: Any): Boolean = other match
    case same: FileScenario => same.file.text == file.text && same.values.sameElements(values)
    case _                  => false

  override def hashCode: Int = values.toSeq.hashCode

  override def name: String                                      = file.name
  override def note: String                                      = file.note
  override def scene: String                                     = file.scene
  private[skein] override def document: Option[(String, String)] = Some(ScenarioFile.Recorded -> file.text)

  override def duration: Span = file.durationS.fold(super.duration)(each => Span.ofSeconds(number(each)))

  def agents: Vector[Agent] = file.vehicles.map: vehicle =>
    val Vector(speed, north, east, down, heading) = vehicle.numbers.map(number): @unchecked
    Agent(
      vehicle.name,
      Role.parse(vehicle.role),
      MetresPerSecond(speed),
      Vector3(north, east, down),
      Radians(heading),
      GraphPolicy(vehicle.policy, values)
    )

  override def limits: Vector[Limit] = file.limits.map(limit => limit.kind.of(limit.numbers.map(number)))

  private lazy val drawn: Vector[(Series, Vector[Measure])] = file.series.map: each =>
    val bound  = each.bound.map((name, value) => Bound(name, number(value)))
    val series = each.graph match
      case Some(graph) => Series.of(each.name, each.unit, GraphQuantity(graph, values), bound)
      case None        => Series(each.name, each.unit, bound)(tracks => each.watched(tracks, _, values))
    (series, each.measures.map(measure(series, _)))

  private def measure(of: Series, by: ScenarioFile.Reduced): Measure =
    val over = by.window match
      case Some(("last", seconds)) => Window.Last(number(seconds))
      case Some((_, seconds))      => Window.After(number(seconds))
      case None                    => Window.Whole
    of.measure(by.name, over, by.reduction)

  override def series: Vector[Series]    = drawn.map(_._1)
  override def measures: Vector[Measure] = drawn.flatMap(_._2)

  override def mistakes: Seq[String] =
    def wrong(what: String, isRight: Double => Boolean, expected: String)(of: Iterable[skein.formula.Node]) =
      of.map(number).find(!isRight(_)).map(came => s"$what: expected $expected, got $came")
    def bound(what: String)(of: Iterable[skein.formula.Node]) = wrong(what, _.isFinite, "finite numbers")(of)
    (wrong("duration", each => each > 0 && each <= FileScenario.LongestS, "more than 0 s and at most a day")(
      file.durationS
    ) ++
      bound("limits")(file.limits.flatMap(_.numbers)) ++
      wrong("measures", each => each.isFinite && each >= 0, "windows of 0 s or more")(
        file.series.flatMap(_.measures).flatMap(_.window.map(_._2))
      ) ++
      bound("series")(file.series.flatMap(_.bound.map(_._2)))).toSeq

private[skein] object FileScenario:
  private val LongestS = 86_400.0

  def apply(file: ScenarioFile, values: Array[Double]): FileScenario = file.over match
    case None       => new FileScenario(file, values)
    case Some(over) => Ending(file, values, over)

  def kind(file: ScenarioFile): ScenarioKind[FileScenario] =
    val mirror = (new Mirror.Product:
      type MirroredMonoType = FileScenario
      def fromProduct(of: Product): FileScenario =
        FileScenario(file, of.productIterator.map(_.asInstanceOf[Double]).toArray)
    ).asInstanceOf[Mirror.ProductOf[FileScenario]]
    ScenarioKind(FileScenario(file, file.settings.map(_.default).toArray))(using mirror)

  /** A file scenario that may end before its duration. It is a separate class because [[OwnEnd]] looks for
    * the class that declares `isOver`.
    */
  private final class Ending(file: ScenarioFile, values: Array[Double], over: Watched)
      extends FileScenario(file, values), KnownEnd:
    override def isOver(known: Known): Boolean = over(known, values) != 0

    lazy val end: EndFormula = EndFormula(
      over.formula(file.settings.map(_.name)) {
        case other: Ending => other.file eq file
        case _             => false
      } {
        case other: Ending => other.values
        case _             => Array.emptyDoubleArray
      },
      over.inputs
    )
