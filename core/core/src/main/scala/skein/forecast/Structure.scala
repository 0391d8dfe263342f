package skein.forecast

import skein.policy.{Axis, SearchSpace}
import skein.vehicle.{ObservedPlant, ReducedModel}

/** Plants of one form that differ in named parameters. `skein identify` fits the parameters to flights and
  * writes them to a model file.
  *
  * @param label its name on the command line and in model files, for example `drag`
  * @param space the free parameters: names with units, bounds, and as defaults the values from which a fit
  *   starts
  * @param make creates the plant from one value per axis; a pure function
  */
final class Structure(val label: String, val space: SearchSpace, make: Vector[Double] => ObservedPlant[?]):
  for name <- label +: names do
    require(
      name.matches("[A-Za-z][A-Za-z0-9-]*"),
      s"structure $label: expected letters, digits and dashes as a name, got '$name'"
    )
  require(!Structure.keys(label), s"expected another label of a structure: '$label' is a key of model files")
  for name <- names do
    require(
      !Structure.keysOfEach(name),
      s"structure $label: expected another name of a parameter: '$name' is a key of model files"
    )

  /** Names of the parameters, in the order of a fit's values. */
  def names: Vector[String] = space.axes.map(_.name)

  def plant(values: Vector[Double]): ObservedPlant[?] =
    require(
      values.size == space.dimension,
      s"structure $label: expected ${space.dimension} values, got ${values.size}"
    )
    make(values)

  override def toString: String = label

/** Structures with the parameters of a [[skein.vehicle.ReducedModel]]. A parameter that is not free has the
  * value at which it has no effect. The bounds are wider than the range of any multirotor.
  */
object Structure:
  /** Keys of a model file other than structures and their parameters. */
  private val keys       = Set("use", "version", "horizon", "altitude-m", "recordings", "vehicles")
  private val keysOfEach =
    Set("predictions", "velocity-rms-mps", "position-rms-m", "against-quadrotor", "against-readings")

  private val gain     = Axis("gain", 0.05, 5, 0.9)
  private val lag      = Axis("lag-s", 0.02, 30, 1)
  private val deadTime = Axis("dead-time-s", 0, 1, 0.05)
  private val drag     = Axis("drag-per-m", 0, 1, 0.005)
  private val turnLag  = Axis("turn-lag-s", 0.02, 30, 1)

  private def reduced(label: String, more: Axis*)(make: Vector[Double] => ReducedModel): Structure =
    Structure(label, SearchSpace(Vector(gain, lag, deadTime) ++ more), make)

  /** A first-order lag with gain and dead time, which is the model that the SIMD kernels simulate. */
  val Lag: Structure = reduced("lag")(v => ReducedModel.lag(v(0), v(1), v(2)))

  /** [[Lag]] with a separate lag for the velocity across the command. */
  val Turn: Structure = reduced("turn", turnLag)(v => ReducedModel(v(0), v(1), v(2), v(3), 0))

  /** [[Lag]] with quadratic drag, and one lag in all directions. */
  val Drag: Structure = reduced("drag", drag)(v => ReducedModel(v(0), v(1), v(2), v(1), v(3)))

  val DragAndTurn: Structure =
    reduced("drag-and-turn", drag, turnLag)(v => ReducedModel(v(0), v(1), v(2), v(4), v(3)))

  val ours: Vector[Structure] = Vector(Lag, Turn, Drag, DragAndTurn)
