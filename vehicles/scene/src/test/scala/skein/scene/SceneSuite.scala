package skein.scene

import skein.units.Vector3

class SceneSuite extends munit.FunSuite:
  private def error(text: String): String =
    SceneFile.parse(text, "my.conf").fold(_.message, scene => fail(s"$scene"))

  test("the bundled scenes are read, and the forest's trees are at least 2.9 m apart"):
    assertEquals(SceneFile.named("empty"), Some(Scene.Empty))
    val trees = SceneFile.named("forest").get.objects
    assertEquals(trees.size, 120)
    for a <- trees; b <- trees if a.name < b.name do
      assert((a.place.position - b.place.position).norm > 2.9 || a.place.position.horizontalDistance(
        b.place.position
      ) >= 3)
    assert(SceneFile.named("street").get.objects.exists(_.name == "Tag2"))
    assertEquals(SceneFile.named("moon"), None)

  test("objects stand with their foot on the ground, and walls and plates are at their stated positions"):
    val scene = SceneFile.parse(
      """objects = [
        |  { box = [2, 4, 6], at = [10, 0] }
        |  { name = W, wall = [0, 5, 0, 9], height-m = 3 }
        |  { tag = 5, side-m = 0.8, at = [1, 2, -3], yaw-deg = 180, id = 9 }
        |]""".stripMargin,
      "a"
    ).fold(error => fail(error.message), identity)
    assertEquals(scene.objects.map(_.name), Vector("Box1", "W", "Tag3"))
    assertEquals(scene.objects(0).place.position, Vector3(10, 0, -3))
    assertEquals(scene.objects(1).place.position, Vector3(0, 7, -1.5))
    assertEquals((scene.objects(2).place.position, scene.objects(2).id), (Vector3(1, 2, -3), Some(9)))

  test("a mistake in a file is reported with its line"):
    assertEquals(
      error("objects = [\n  { box = [1, 2], at = [0, 0] }\n]"),
      "my.conf: 2: box: expected 3 numbers in brackets"
    )
    assertEquals(error("objects = [\n\n  { box = [1, 2, 3] }\n]"), "my.conf: 3: at is missing")
    assert(
      error("ground = 5").startsWith("my.conf: 1: ground: expected a colour such as \"#6b7f4f\", got 5")
    )
    assert(
      error("objects = [{ tag = 587, at = [0, 0] }]").contains("tag: expected a number from 0.0 to 586.0")
    )
    assert(error("objcts = []").contains("no key objcts; there are"))
    assert(
      error("objects = [{ pole = [1, 2], at = [0, 0], name = Ground }]").contains("is the ground's name")
    )
    assert(error("objects = [").startsWith("my.conf: 1"))
    assert(error("objects = [{}]").endsWith("expected one of box, pole, wall or tag, got nothing"))
    assert(error("objects = [{ boxx = [1, 1, 1], at = [0, 0] }]").endsWith("got at, boxx"))
    for what <- Seq("\"/etc/passwd\"", "file(\"/a\")", "required(file(\"/a\"))", "classpath(\"a\")") ++
        Seq("url(\"http://127.0.0.1:9/a.conf\")", "required(url(\"http://127.0.0.1:9/a.conf\"))")
    do assert(clue(error(s"include $what")).contains("includes no other file"), what)
    assert(clue(error("ground = ${PATH}")).contains("PATH"))
    assert(clue(error("objects = " + "[" * 100_000)).contains("nested too deeply"))

  private val house =
    SceneObject("House", Shape.Box(Vector3(2, 3, 4)), Placement(Vector3(10, 0, -4)), 0, None)
  private val pole  = SceneObject("Pole", Shape.Pole(0.5, 5), Placement(Vector3(0, 10, -5)), 0, None)
  private val scene = Scene(Vector(house, pole))
  private val half  = Vector3(0.3, 0.3, 0.1)

  test("the contact of two overlapping boxes states the depth and the direction out"):
    val contact = Contact.of(scene, Placement(Vector3(7.8, 1, -2)), half).get
    assertEquals(contact.item, 1)
    assertEqualsDouble(contact.depthM, 0.1, 1e-9)
    assertEquals(contact.normal, Vector3(-1, 0, 0))
    assertEqualsDouble(contact.point.x, 8.1, 1e-9)
    assertEquals(Contact.of(scene, Placement(Vector3(7.69, 1, -2)), half), None)

  test("a body that moves no farther than the clearance touches nothing"):
    val at   = Vector3(0, 5, -3)
    val free = Contact.clearanceM(scene, at, half.norm)
    for angle <- 0 until 360 by 5 do
      val way =
        Vector3(math.cos(math.toRadians(angle)), math.sin(math.toRadians(angle)), 0) * math.max(0, free)
      assertEquals(Contact.of(scene, Placement.turned(at + way, angle, 10, angle), half), None)
    assert(Contact.clearanceM(Scene.Empty, at, 1).isInfinite)

  test("objects and the ground block lines of sight, except for the observer"):
    val moment = Moment(scene, Vector.empty)
    assert(!moment.sees(Vector3(0, 0, -2), Vector3(20, 0, -2)))
    assert(moment.sees(Vector3(0, 0, -2), Vector3(20, 0, -2), except = 1))
    assert(moment.sees(Vector3(0, 0, -9), Vector3(20, 0, -9)))
    assert(!moment.sees(Vector3(0, 0, -9), Vector3(0, 0, 1)))
