package skein.simulator

import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.file.Files
import skein.scene.{Moment, Placement, Scene, SceneObject, Shape}
import skein.testing.TemporaryFolders
import skein.units.Vector3

class VoxelGridSuite extends munit.FunSuite, TemporaryFolders:

  private def boxes(centres: Seq[Vector3]): Moment = Moment(
    Scene.Empty,
    centres.toVector.map(at => SceneObject("V", Shape.Box(Vector3(0.3, 0.3, 0.05)), Placement(at), 0, None))
  )

  private val ground = boxes(Seq.empty)

  /** Splits a file into the header's lines and the cells. */
  private def read(file: Array[Byte]): (Seq[String], Vector[Boolean]) =
    val text   = String(file, US_ASCII)
    val start  = text.indexOf("data\n") + 5
    val header = text.take(start).linesIterator.toSeq
    val cells  =
      file.drop(start).grouped(2).flatMap(pair => Vector.fill(pair(1) & 0xff)(pair(0) == 1)).toVector
    (header, cells)

  test("the ground fills the cells below it, in the order of the format"):
    val (header, cells) = read(VoxelGrid.render(ground, Vector3(0, 0, 0), (2, 6, 4), 1).toOption.get)
    assertEquals(header.take(2), Seq("#binvox 1", "dim 2 4 6"))
    assertEquals(cells.size, 2 * 4 * 6)
    // x fastest, then up, then y: of four layers around z = 0, the ground touches the one at its height.
    for j <- 0 until 6; k <- 0 until 4; i <- 0 until 2 do
      assertEquals(cells(i + 2 * (k + 4 * j)), k <= 2, s"$i $j $k")

  test("a vehicle fills cells in the air"):
    val flying     = boxes(Seq(Vector3(3, 0, -50)))
    val (_, cells) = read(VoxelGrid.render(flying, Vector3(0, 0, -50), (10, 10, 10), 1).toOption.get)
    val filled     = cells.indices.filter(cells)
    assert(filled.nonEmpty && filled.size < 30, s"${filled.size} cells")
    assert(filled.contains(8 + 10 * (5 + 10 * 5)))

  test("at the limit of vehicles each fills one cell and little more"):
    val crowd                 = boxes(Seq.tabulate(256)(i => Vector3(i % 16, i / 16, -500)))
    def cells(moment: Moment) =
      read(VoxelGrid.render(moment, Vector3(0, 0, -500), (128, 128, 128), 1).toOption.get)._2.count(identity)
    assertEquals(cells(ground), 0)
    val filled = cells(crowd)
    assert(filled >= 256 && filled < 256 * 27, s"$filled cells")

  test("long runs are split at 255"):
    val (_, cells) = read(VoxelGrid.render(ground, Vector3(0, 0, -500), (10, 10, 10), 1).toOption.get)
    assertEquals(cells, Vector.fill(1000)(false))

  test("a grid without cells, or with too many, is refused"):
    for (size, edge) <- Seq(
        (0, 1, 1)            -> 1f,
        (10, 10, 10)         -> 0f,
        (10, 10, 10)         -> -1f,
        (1000, 1000, 1000)   -> 1f,
        (Int.MaxValue, 1, 1) -> 1e-30f
      )
    do
      assert(VoxelGrid.render(ground, Vector3.Zero, size, edge).isLeft, s"$size $edge")

  folder.test("a grid is written to a new file or over an older grid, and over nothing else"): folder =>
    val grids              = GridFolder(folder)
    val grid               = VoxelGrid.render(ground, Vector3.Zero, (4, 4, 4), 1).toOption.get
    def save(name: String) = grids.file(name).exists(grids.save(_)(grid))
    val fresh              = folder.resolve("a.binvox")
    assert(save("a.binvox"))
    assert(grids.file(fresh.toString).exists(grids.save(_)(grid.take(40))))
    assertEquals(Files.size(fresh), 40L)
    val diary = Files.writeString(folder.resolve("diary.binvox"), "dear diary")
    assert(!save("diary.binvox"))
    assertEquals(Files.readString(diary), "dear diary")
    Files.createSymbolicLink(folder.resolve("link.binvox"), fresh): Unit
    assert(!save("link.binvox"))

  folder.test(
    "no client can write a file elsewhere, over a file of another kind, or beyond the folder's limit"
  ): folder =>
    val grids = GridFolder(folder)
    for path <- Seq(
        "/tmp/x.binvox",
        "../x.binvox",
        s"$folder/../x.binvox",
        s"$folder/deep/x.binvox",
        "deep/x.binvox",
        "profile",
        "",
        "\u0000.binvox"
      )
    do assert(grids.file(path).isLeft, path)
    for i <- 1 to GridFolder.Most do assert(grids.file(s"$i.binvox").exists(grids.save(_)(Array(1))))
    assert(!grids.file("more.binvox").exists(grids.save(_)(Array(1))))

  folder.test("one grid is made at a time, and a simulator without a folder makes none"): folder =>
    val grids = GridFolder(folder)
    val file  = grids.file("a.binvox").toOption.get
    def both  = grids.save(file)({ grids.save(file)(Array(1)); Array(2) })
    assert(intercept[BadArgument](both).getMessage.contains("one is made at a time"))
    assert(grids.save(file)(Array(3)))
    val said = Bench().error("simCreateVoxelGrid", SampleCalls.params("simCreateVoxelGrid")*)
    assert(said.contains("--grids"), said)

  test("the greatest grid with as many vehicles as allowed takes some 0.1 s"):
    val crowd = boxes(Seq.fill(256)(Vector3.Zero))
    val begun = java.lang.management.ManagementFactory.getThreadMXBean.getCurrentThreadCpuTime
    assert(VoxelGrid.render(crowd, Vector3.Zero, (1, 1, 1), 0.004f).isRight)
    val spentS =
      (java.lang.management.ManagementFactory.getThreadMXBean.getCurrentThreadCpuTime - begun) * 1e-9
    assert(spentS < 5, s"$spentS s of processor time")
