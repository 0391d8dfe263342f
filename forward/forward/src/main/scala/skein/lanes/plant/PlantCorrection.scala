package skein.lanes.plant

import skein.formula.{Op, Untraceable}
import skein.lanes.policy.LaneObservation
import skein.simd.FixedFormula
import skein.vehicle.ObservedPlant

/** How readings set a plant's state right in many worlds at once, compiled from [[ObservedPlant.corrected]]:
  * of the state's numbers, then position and velocity.
  *
  * @param count how many numbers the state is
  */
private[lanes] final class PlantCorrection private (formula: FixedFormula, count: Int):
  import formula.bound

  /** Whether a reading tells all of the state. */
  val isTold: Boolean = bound.inputs.forall(_ >= count)

  /** Whether the state is the reading itself, number for number. */
  val isReading: Boolean =
    isTold && bound.inputs.toVector == Vector.range(count, count + LaneObservation.READ) &&
      bound.nodes.zipWithIndex.forall((node, i) => node.op == Op.Input && node.index == i)

  def call: FixedFormula.Call = formula.call

private[lanes] object PlantCorrection:
  /** @return or why readings do not set the state right by lanes
    */
  def of(plant: ObservedPlant[?], count: Int): Either[String, PlantCorrection] =
    FixedFormula
      .of(plant, "corrected", alike = 0)
      .map(PlantCorrection(_, count))
      .left
      .map((why: Untraceable) => s"what a reading tells of the vehicle is no formula: ${why.getMessage}")
