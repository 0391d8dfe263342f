package skein.ros.message

class MessageDefinitionSuite extends munit.FunSuite:

  private def snake(name: String) =
    name.flatMap(letter => if letter.isUpper then s"_${letter.toLower}" else s"$letter")

  private def check(value: Any, name: String): Unit = value match
    case fields: Product =>
      assertEquals(MessageDefinition.fieldNames(name), fields.productElementNames.map(snake).toVector, name)
    case _ => fail(name)

  private val defined = Set("TFMessage", "Odometry", "TwistStamped", "Image", "PointCloud2")

  test("a definition has the fields of its message, in order"):
    val samples = Samples.all.filter(sample => defined(sample.kind.name))
    assertEquals(samples.map(_.kind.name).toSet, defined)
    for sample <- samples do check(sample.value, s"${sample.kind.packageName}/${sample.kind.name}")

  test("a definition is followed by the definitions of the types in it, each once"):
    val whole = MessageDefinition.whole(summon[MessageType[TwistStamped]])
    assertEquals(
      whole,
      s"""std_msgs/Header header
         |geometry_msgs/Twist twist
         |${"=" * 80}
         |MSG: std_msgs/Header
         |builtin_interfaces/Time stamp
         |string frame_id
         |${"=" * 80}
         |MSG: builtin_interfaces/Time
         |int32 sec
         |uint32 nanosec
         |${"=" * 80}
         |MSG: geometry_msgs/Twist
         |geometry_msgs/Vector3 linear
         |geometry_msgs/Vector3 angular
         |${"=" * 80}
         |MSG: geometry_msgs/Vector3
         |float64 x
         |float64 y
         |float64 z
         |""".stripMargin
    )
