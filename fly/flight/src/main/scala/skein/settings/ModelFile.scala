package skein.settings

import com.typesafe.config.Config
import skein.forecast.Structure
import skein.identify.*
import skein.scenario.Scenarios
import skein.units.Expect
import skein.vehicle.{ObservedPlant, ReducedModel}

/** A fitted model as a HOCON file: `skein.model`, with every fitted structure, its data and its errors.
  *
  * @param use the structure to apply
  * @param models the parameters' values of each structure
  * @param altitudeM altitude of the fitted flights, if its plant is only valid there, as AirSim's quadrotor
  *   is; files of older versions lack it
  */
final case class ModelFile(
    use: Structure,
    models: Map[Structure, Vector[Double]],
    altitudeM: Option[Double] = None
):

  val plant: ObservedPlant[?] = use.plant(models(use))

  /** The three-parameter model, for code that supports only this one. */
  def reduced: Option[ReducedModel] =
    models.get(Structure.Lag).map(lag => ReducedModel.lag(lag(0), lag(1), lag(2)))

object ModelFile:
  import FittedFile.{line, list, number}

  /** Tolerance of the altitude, m: within it, a lag of AirSim's changes by 0.1 s. */
  private val SameAltitudeM = 1.0

  /** Why a model of one altitude must not be used at another altitude, if that is so. */
  def mistake(flownAtM: Option[Double], altitudeM: Double): Option[String] =
    flownAtM
      .filter(flown => math.abs(flown - altitudeM) > SameAltitudeM)
      .map(flown =>
        s"expected a model of flights at ${number(altitudeM)} m altitude, since the vehicles' lag depends on it, got one of ${number(flown)} m"
      )

  /** The data of a fit.
    *
    * @param altitudeM altitude that all commands held, if it was one
    * @param recordings files, each with its flight
    */
  final case class Provenance(
      recordings: Vector[String],
      vehicles: Vector[String],
      horizonS: Double,
      version: String,
      altitudeM: Option[Double] = None
  )

  def render(use: Structure, fits: Vector[Fit], from: Provenance): String =
    val sections = fits.map: fit =>
      val found      = fit.identification
      val parameters = found.parameters.map("    " + line(_, "at its bound: not identified"))
      val errors     = Vector(
        "against-quadrotor" -> fit.againstQuadrotor,
        "against-readings"  -> fit.againstReadings
      ).collect { case (against, errors) if errors.nonEmpty => table(against, errors) }
      s"""  ${found.structure.label} {
         |${parameters.mkString("\n")}
         |    predictions = ${found.predictions}
         |    velocity-rms-mps = ${number(found.velocityRmsMps)}
         |    position-rms-m = ${number(found.positionRmsM)}
         |${errors.mkString("\n")}
         |  }""".stripMargin
    s"""# A model of how horizontal velocity follows its command, fitted by `skein identify`.
       |# least and most: 95 % intervals by the sandwich estimator over blocks of ${number(
        Identification.blockS(from.horizonS)
      )} s of flight.
       |skein.model {
       |  # Which of the structures below to fly by.
       |  use = ${use.label}
       |
       |  version = ${quoted(from.version)}
       |  horizon = ${number(from.horizonS)} s
       |${from.altitudeM.fold("  # The commands did not hold one altitude.")(metres =>
        s"  altitude-m = ${number(metres)}"
      )}
       |${list("recordings", from.recordings)}
       |${list("vehicles", from.vehicles)}
       |
       |${sections.mkString("\n\n")}
       |}
       |""".stripMargin

  private def table(name: String, errors: Vector[HorizonError]): String =
    val lines = errors.map: error =>
      s"      { horizon = ${number(error.horizonS)} s, " +
        s"position-p50-m = ${number(error.positionP50M)}, position-p95-m = ${number(error.positionP95M)}, " +
        s"velocity-p50-mps = ${number(error.velocityP50Mps)}, velocity-p95-mps = ${number(error.velocityP95Mps)} }"
    lines.mkString(s"    $name = [\n", "\n", "\n    ]")

  /** Reads a file.
    *
    * @return Left says what is wrong, with the line
    */
  def read(path: String)(using Scenarios): Either[String, ModelFile] =
    TextFile.read(path).flatMap(parse(_, path))

  private[skein] def parse(text: String, path: String)(using
      scenarios: Scenarios
  ): Either[String, ModelFile] =
    FittedFile.parse(text, path, "skein.model", "model file"): section =>
      for
        use <- scenarios.structure(section.getString("use")).left.map(wrong => s"$path: use: $wrong")
        models = scenarios.structures.filter(found => section.hasPath(found.label)).map: structure =>
          structure -> values(section.getConfig(structure.label), structure)
        _ <- Expect.that(models.exists(_._1 == use)):
          s"$path: use = ${use.label}, but there is no section ${use.label}"
      yield ModelFile(
        use,
        models.toMap,
        Option.when(
          section.hasPath("altitude-m") && Structure.ours.contains(use)
        )(section.getDouble("altitude-m"))
      )

  private def values(section: Config, structure: Structure): Vector[Double] =
    structure.names.map: name =>
      val value = section.getDouble(s"$name.value")
      require(value.isFinite, s"$name: expected a finite number, got $value")
      value

  private def quoted(text: String): String = com.typesafe.config.ConfigUtil.quoteString(text)

/** A fitted structure with its errors over the horizons.
  *
  * @param againstQuadrotor compared with the built-in quadrotor under equal commands, for a structure of
  *   Skein's
  * @param againstReadings compared with the recordings themselves
  */
final case class Fit(
    identification: Identification,
    againstQuadrotor: Vector[HorizonError],
    againstReadings: Vector[HorizonError]
)
