package skein.settings

import scala.jdk.CollectionConverters.*
import skein.fusion.SensorModel
import skein.identify.SensorFit
import skein.signal.LatencyDistribution

/** A fitted [[SensorModel]] as a HOCON file: `skein.sensor`, with its data. */
object SensorFile:
  import FittedFile.{line, list, number}

  /** The text of a file.
    *
    * @param recordings the recordings to which it was fitted
    */
  def render(fit: SensorFit, recordings: Vector[String]): String =
    import fit.model
    val fitted = fit.fitted.map("  " + line(_, "at its bound"))
    s"""# What a pursuer that sees by a camera alone knows of its evader, fitted by `skein identify`.
       |# least and most: 95 % intervals, as if detections were independent.
       |skein.sensor {
       |${fitted.mkString("\n")}
       |  every-s = ${number(model.everyS)}
       |  fov-deg = ${number(StrictMath.toDegrees(model.fovRad))}
       |  farthest-m = ${number(model.farthestM)}
       |  workers = ${model.workers}
       |  deadline-s = ${number(model.deadlineS)}
       |  # Quantiles, evenly spread from the least to the largest.
       |  takes-ms = [${quantiles(model.takes).map(number).mkString(", ")}]
       |  images = ${fit.images}
       |  detections = ${fit.detections}
       |${list("recordings", recordings)}
       |}
       |""".stripMargin

  def read(path: String): Either[String, SensorModel] = TextFile.read(path).flatMap(parse(_, path))

  private[skein] def parse(text: String, path: String): Either[String, SensorModel] =
    FittedFile.parse(text, path, "skein.sensor", "sensor's file"): section =>
      def fitted(name: String) = section.getDouble(s"$name.value")
      Right(SensorModel(
        section.getDouble("every-s"),
        StrictMath.toRadians(section.getDouble("fov-deg")),
        section.getDouble("farthest-m"),
        fitted("detection"),
        StrictMath.toRadians(fitted("bearing-sd-deg")),
        fitted("range-bias"),
        fitted("range-sd"),
        LatencyDistribution.ofSamples(section.getDoubleList("takes-ms").asScala.map(_.doubleValue).toVector),
        section.getInt("workers"),
        section.getDouble("deadline-s")
      ))

  private def quantiles(takes: LatencyDistribution): Vector[Double] = takes match
    case LatencyDistribution.Quantiles(_, ms) => ms
    case other                                => Vector(0.0, 1.0).map(other.quantile(_).toMillis)
