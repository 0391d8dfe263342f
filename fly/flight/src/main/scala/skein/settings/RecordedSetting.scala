package skein.settings

import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.loop.{AnyLoop, Fallback, Knowledge, PlanSettings, Strangers}
import skein.record.ParameterRow
import skein.scenario.{Scenario, Scenarios}
import skein.signal.LatencyProfile
import skein.units.{Expect, Span}
import skein.vehicle.SensorNoise

/** How a recording stores a setting: as parameters, under the name of its field. */
private[settings] trait RecordedSetting[A]:
  def written(name: String, value: A): Seq[ParameterRow]

  /** Reads the recorded value; None in a recording of a version that did not store it.
    *
    * @return Left says what was expected, and what was found
    */
  def read(name: String, parameters: Map[String, String])(using Scenarios): Either[String, Option[A]]

private[settings] object RecordedSetting:

  /** How a recording stores the fields of a case class: by their types. */
  final class Fields[A <: Product](
      mirror: Mirror.ProductOf[A],
      fields: Vector[(String, RecordedSetting[Any])]
  ):
    def written(settings: A): Seq[ParameterRow] =
      fields.zip(settings.productIterator).flatMap { case ((name, field), value) =>
        field.written(name, value)
      }

    /** Reads all fields; one that is not on record is taken from `otherwise`. */
    def read(parameters: Map[String, String], otherwise: A)(using Scenarios): Either[String, A] =
      Expect
        .each(fields.zip(otherwise.productIterator)) { case ((name, field), value) =>
          field.read(name, parameters).map(_.getOrElse(value))
        }
        .map(values => mirror.fromProduct(Tuple.fromArray(values.toArray)))

  inline def fields[A <: Product](using mirror: Mirror.ProductOf[A]): Fields[A] = Fields(
    mirror,
    constValueTuple[mirror.MirroredElemLabels].toList.map(_.toString).toVector.zip(
      summonAll[
        Tuple.Map[mirror.MirroredElemTypes, RecordedSetting]
      ].toList.asInstanceOf[List[RecordedSetting[Any]]]
    )
  )

  def written[A](name: String, value: A)(using setting: RecordedSetting[A]): Seq[ParameterRow] =
    setting.written(name, value)

  given name: RecordedSetting[String] = Text[String]("a name", identity)(Some(_))

  given int: RecordedSetting[Int] = Text[Int]("a whole number", _.toString)(_.toIntOption)

  given boolean: RecordedSetting[Boolean] =
    Text[Boolean]("true or false", _.toString, isUsual = !_)(_.toBooleanOption)

  given RecordedSetting[PlanSettings] = Text[PlanSettings]("settings of plans", _.text)(PlanSettings.parse)

  given RecordedSetting[SimulatedBody] =
    Text[SimulatedBody](SimulatedBody.forms, _.text, isUsual = _.isAirSim)(SimulatedBody.recorded(_).toOption)

  given RecordedSetting[SensorNoise] =
    Text[SensorNoise](SensorNoise.forms, _.text)(SensorNoise.parse(_).toOption)

  given RecordedSetting[Wire]      = labelled(Wire.values, _.label, usual = Wire.AirSim)
  given RecordedSetting[Knowledge] = labelled(Knowledge.values, _.label, usual = Knowledge.All)

  given RecordedSetting[Strangers] = labelled(Strangers.values, _.label, usual = Strangers.Turn)

  given RecordedSetting[SolverChoice] =
    Text[SolverChoice]("where a solver is", _.text)(SolverChoice.parse(_).toOption)

  given RecordedSetting[VehicleLink] =
    Text[VehicleLink]("a link between vehicles", _.text)(VehicleLink.parse(_).toOption)

  given RecordedSetting[Fallback] =
    Text[Fallback]("hold, repeat, hover or a policy", _.label)(Fallback.parse(_).toOption)

  given RecordedSetting[List[ImageSource]] =
    Text[List[ImageSource]](
      "sources of images, with a space between two",
      _.map(_.text).mkString(" "),
      isUsual = _.isEmpty
    ): text =>
      val (wrong, sources) = text.split(' ').toList.partitionMap(ImageSource.parse)
      Option.when(wrong.isEmpty)(sources)

  given RecordedSetting[PredictionModel] with
    private def text(parse: Scenarios ?=> String => Option[PredictionModel]) =
      Text[PredictionModel](PredictionModel.recordedForms, PredictionModel.text)(parse)

    def written(name: String, value: PredictionModel): Seq[ParameterRow] =
      text(PredictionModel.recorded).written(name, value)

    def read(name: String, parameters: Map[String, String])(using Scenarios) =
      if parameters.contains(name) then text(PredictionModel.recorded).read(name, parameters)
      else text(PredictionModel.recordedAsModel).read(OlderPredictor, parameters)

  /** The parameter of the predictor in recordings of older versions. */
  val OlderPredictor = "model"

  given RecordedSetting[NamedScene] with
    def written(name: String, value: NamedScene): Seq[ParameterRow]          = NamedScene.recorded(value)
    def read(name: String, parameters: Map[String, String])(using Scenarios) =
      NamedScene.ofRecording(parameters).map(Some(_))

  given option[A](using one: RecordedSetting[A]): RecordedSetting[Option[A]] with
    def written(name: String, value: Option[A]): Seq[ParameterRow] = value.toSeq.flatMap(one.written(name, _))
    def read(name: String, parameters: Map[String, String])(using Scenarios) =
      one.read(name, parameters).map(_.map(Some(_)))

  given time: RecordedSetting[Option[Span]] with
    private val nanos = Text[Span]("nanoseconds", _.toNanos.toString)(
      _.toLongOption.filter(_ > 0).map(Span.ofNanos)
    )
    def written(name: String, value: Option[Span]): Seq[ParameterRow] =
      value.toSeq.flatMap(nanos.written(s"${name}Ns", _))
    def read(name: String, parameters: Map[String, String])(using Scenarios) =
      nanos.read(s"${name}Ns", parameters).map(_.map(Some(_)))

  given RecordedSetting[Scenario] with
    def written(name: String, value: Scenario): Seq[ParameterRow] = ScenarioSettings.recorded(value)

    // The flight's columns name it.
    def read(name: String, parameters: Map[String, String])(using Scenarios) = Right(None)

  // These are in columns, or one of them is in a flight's plan.
  given loops: RecordedSetting[List[AnyLoop]]        = Elsewhere()
  given links: RecordedSetting[List[LatencyProfile]] = Elsewhere()
  given times: RecordedSetting[Span]                 = Elsewhere()
  given seeds: RecordedSetting[Long]                 = Elsewhere()
  given policies: RecordedSetting[List[PolicyFile]]  = Elsewhere()

  private def labelled[A](values: Array[A], label: A => String, usual: A): RecordedSetting[A] =
    Text[A](values.map(label).mkString(" or "), label, isUsual = _ == usual)(text =>
      values.find(label(_) == text)
    )

  /** A single parameter.
    *
    * @param isUsual whether a value is the default, which is not written
    */
  private final class Text[A](
      expected: Scenarios ?=> String,
      text: A => String,
      isUsual: A => Boolean = (_: A) => false
  )(parse: Scenarios ?=> String => Option[A])
      extends RecordedSetting[A]:
    def written(name: String, value: A): Seq[ParameterRow] =
      if isUsual(value) then Nil else Seq(ParameterRow(name, text(value)))

    def read(name: String, parameters: Map[String, String])(using Scenarios) =
      Expect
        .each(parameters.get(name)): value =>
          parse(value).toRight(s"its parameter '$name': expected $expected, got '$value'")
        .map(_.headOption)

  private final class Elsewhere[A] extends RecordedSetting[A]:
    def written(name: String, value: A): Seq[ParameterRow]                   = Nil
    def read(name: String, parameters: Map[String, String])(using Scenarios) = Right(None)
