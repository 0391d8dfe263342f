package skein.ros.message

/** Messages against the bytes that `rclpy` and `rosbags` write for them. */
class MessageGolden extends munit.FunSuite:

  test("every message that rclpy or rosbags has written is read with its original values"):
    for (name, bytes) <- Samples.written do
      val sample = Samples.of(name)
      assertEquals(sample.read(bytes), Right(sample.value), name)

  test("every message is written as rclpy and rosbags write it, with zeros as padding"):
    val little = Samples.written.filter(_.bytes(1) == 1)
    assertEquals(little.map(_.name).toSet, Samples.all.map(_.kind.name).toSet)
    for (name, bytes) <- little do
      val ours = Samples.of(name).written
      assertEquals(ours.length, bytes.length, name)
      // rclpy leaves padding bytes as they were in memory.
      for at <- ours.indices if ours(at) != bytes(at) do assertEquals(ours(at), 0.toByte, s"$name, byte $at")

  test("both byte orders are read"):
    assertEquals(
      Samples.written.filter(_.bytes(1) == 0).map(_.name),
      Vector("TFMessage", "CameraInfo", "PointCloud2")
    )
