package skein.simulator

import skein.scene.{Placement, SceneObject, Shape}
import skein.units.{Quaternion, Vector3}
import skein.vehicle.Airframe

/** A multirotor's shape: its box, two crossed beams, four rotors, and tags on its sides if the scene has
  * them.
  */
private[skein] object MultirotorBody:
  import SceneObject.Part

  def parts(airframe: Airframe, number: Int, tagM: Double): Vector[Part] =
    val offset = airframe.rotorOffsetM
    val box    = Shape.Box(Vector3(airframe.boxFrontM, airframe.boxRightM, airframe.boxDownM) * 0.5)
    val beam   = Shape.Box(Vector3(airframe.armM, 0.012, 0.01))
    val rotor  = Shape.Pole(airframe.rotorDiameterM / 2, airframe.rotorHeightM / 2)
    Part(box, at(Vector3.Zero), 0x2b2f36) +:
      Vector(45, 135).map(yaw => Part(beam, at(Vector3.Zero, yaw), 0x3c424b)) ++:
      (for front <- Vector(1, -1); right <- Vector(1, -1)
      yield Part(
        rotor,
        // Above the box, as on a real one, not below as AirSim computes them.
        at(Vector3(front * offset, right * offset, -airframe.rotorDownM)),
        if front > 0 then 0xd8452e else 0x8d939c
      )) ++: tags(number, tagM)

  private def tags(number: Int, side: Double): Vector[Part] =
    if side == 0 then Vector.empty
    else
      for yaw <- Vector(0, 90, 180, 270) yield
        val turned = at(Vector3.Zero, yaw)
        Part(
          Shape.Tag(number % skein.scene.AprilTag.count, side),
          Placement(turned.front * (side * 5 / 8 + 0.002), turned.orientation),
          0xffffff
        )

  private def at(position: Vector3, yawDeg: Double = 0): Placement =
    if yawDeg == 0 then Placement(position, Quaternion.Identity) else Placement.turned(position, 0, 0, yawDeg)
