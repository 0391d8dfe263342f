package skein.figures

import skein.measure.Distribution
import skein.observe.ObservedVehicle
import skein.plot.*

/** The paper's four observations of an outside program: for each vehicle a bar for the mean, and a line up to
  * the 99th percentile, all on one scale. Ages count from the sampling of physics.
  */
object ObservedFigure:
  private val colour   = Colour(0x0072b2)
  private val whisker  = Stroke(Colour(0x111111), 1.2)
  private val barWidth = 26.0
  private val place    = 72.0

  def apply(observed: Vector[ObservedVehicle]): Option[Drawing] =
    val vehicles = observed.filter(_.commands > 0).take(Most)
    // For a single vehicle, quantities of others have no value, and so no panel.
    val panels = quantities.filter((_, of) => vehicles.exists(of(_).isDefined))
    val most   = panels.flatMap((_, of) => vehicles.flatMap(of)).map(_.p99).maxOption.getOrElse(1.0)
    Option.when(panels.nonEmpty):
      Drawing.stacked(
        Drawing.grid(panels.map(panel(_, _, vehicles, most)), columns = 2),
        Legend(46, Legend.box("mean", colour), Legend.line("99 % are shorter", whisker))
      )

  private val Most = 20

  private val quantities: Vector[(String, ObservedVehicle => Option[Distribution])] = Vector(
    "Age of own data"             -> (_.ownAgeMs),
    "Age of the others' data"     -> (_.othersAgeMs),
    "Time since own last command" -> (_.everyMs),
    "Time since others' command"  -> (_.sinceOthersMs)
  )

  private def panel(
      title: String,
      of: ObservedVehicle => Option[Distribution],
      vehicles: Vector[ObservedVehicle],
      most: Double
  ): Drawing =
    val width = place * vehicles.size.max(3)
    val panel = ObservationFigure.bars(width, most)
    val bars  = vehicles.zipWithIndex.flatMap: (vehicle, index) =>
      val middle = panel.left + width * (index + 0.5) / vehicles.size
      val name   = if vehicle.name.isEmpty then "(the first)" else vehicle.name.take(12)
      val label  = Mark.Text(Point(middle, panel.bottom + 13), name, Theme.smallSize, anchor = Anchor.Middle)
      label +: of(vehicle).toVector.flatMap: values =>
        val (left, right) = (middle - barWidth / 2, middle + barWidth / 2)
        Vector(
          Mark.box(left, panel.atY(values.mean), right, panel.bottom, colour),
          Mark.line(Point(middle, panel.atY(values.p99)), Point(middle, panel.atY(values.mean)), whisker)
        )
    val rules = panel.rules(panel.left, panel.right)
    Drawing(width + 76, panel.height + 66, (panel.title(title) +: rules) ++ panel.yAxis ++ bars)
