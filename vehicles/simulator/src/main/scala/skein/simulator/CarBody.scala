package skein.simulator

import skein.scene.{Placement, SceneObject, Shape}
import skein.units.{Quaternion, Vector3}

/** A car's shape: a body and a cabin. Its dimensions are those of a BMW 320i, as in `SingleTrack`. */
private[simulator] object CarBody:
  import SceneObject.Part

  private val LongM   = 4.508
  private val WideM   = 1.610
  private val HighM   = 1.42
  private val ClearM  = 0.15
  private val BonnetM = 0.9

  /** Half lengths and middle of the bounding box, which stands on the ground. */
  val half: Vector3   = Vector3(LongM / 2, WideM / 2, HighM / 2)
  val middle: Vector3 = Vector3(0, 0, -HighM / 2)

  val parts: Vector[Part] = Vector(
    box(0, LongM / 2, ClearM, BonnetM, 0x2f6db5),
    box(-0.3, LongM / 4, BonnetM, HighM, 0x22303f)
  )

  private def box(frontM: Double, halfLongM: Double, fromM: Double, toM: Double, colour: Int) = Part(
    Shape.Box(Vector3(halfLongM, WideM / 2, (toM - fromM) / 2)),
    Placement(Vector3(frontM, 0, -(fromM + toM) / 2), Quaternion.Identity),
    colour
  )
