package skein.lanes.plant

import skein.formula.{Op, Untraceable}
import skein.lanes.policy.LaneObservation
import skein.simd.FixedFormula
import skein.vehicle.PlantTiming

/** Corrects a plant's state by readings, in many worlds with SIMD. Compiled from the method `corrected` of an
  * [[skein.vehicle.ObservedPlant]] or [[skein.vehicle.ObservedSpatialPlant]]; inputs are the state's
  * components, then position and velocity.
  *
  * @param count number of components of the state
  */
private[lanes] final class PlantCorrection private (formula: FixedFormula, count: Int):
  import formula.bound

  /** Whether a reading determines the whole state. */
  val isTold: Boolean = bound.inputs.forall(_ >= count)

  /** Whether the state consists of exactly the reading's components, in their order. */
  val isReading: Boolean =
    isTold && bound.inputs.toVector == Vector.range(count, count + LaneObservation.READ) &&
      bound.nodes.zipWithIndex.forall((node, i) => node.op == Op.Input && node.index == i)

  def call: FixedFormula.Call = formula.call

private[lanes] object PlantCorrection:
  /** Compiles the correction. Left says why SIMD does not support it. */
  def of(plant: PlantTiming, count: Int): Either[String, PlantCorrection] =
    FixedFormula
      .of(plant, "corrected", alike = 0)
      .map(PlantCorrection(_, count))
      .left
      .map((why: Untraceable) => s"what a reading tells of the vehicle is no formula: ${why.getMessage}")
