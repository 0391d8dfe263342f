package skein.recognition

class OnnxDetectorSuite extends munit.FunSuite:
  private def box(left: Double, width: Double, score: Double, kind: Int = 0) =
    Box(left, 0, left + width, 10, kind, score)

  test("of overlapping boxes of one kind only the best counts"):
    val found = Vector(box(0, 10, 0.6), box(1, 10, 0.9), box(1, 10, 0.7, kind = 1), box(30, 10, 0.55))
    assertEquals(
      OnnxDetector.distinct(found, 0.45),
      Vector(box(1, 10, 0.9), box(1, 10, 0.7, kind = 1), box(30, 10, 0.55))
    )
    assertEqualsDouble(box(0, 10, 1).overlap(box(5, 10, 1)), 1.0 / 3, 1e-12)
    assertEqualsDouble(box(0, 10, 1).overlap(box(10, 10, 1)), 0, 0)

  test("boxes are read as columns and as rows, and the weak ones are left out"):
    val columns = OnnxModel.Output(Vector(1, 6, 2), Array(20f, 5, 10, 5, 8, 2, 4, 2, 0.1f, 0.2f, 0.9f, 0.3f))
    assertEquals(
      OnnxDetector.read(columns, BoxForm.Columns, 0.5),
      Right(Vector(Box(16, 8, 24, 12, 1, 0.9f.toDouble)))
    )
    val rows = OnnxModel.Output(Vector(1, 2, 6), Array(1f, 2, 3, 4, 0.8f, 2, 5, 6, 7, 8, 0.4f, 0))
    assertEquals(
      OnnxDetector.read(rows, BoxForm.Rows, 0.5),
      Right(Vector(Box(1, 2, 3, 4, 2, 0.8f.toDouble)))
    )

  test("an output of another form is reported with what was expected"):
    val other = OnnxModel.Output(Vector(1, 3, 4), new Array[Float](12))
    assertEquals(
      OnnxDetector.read(other, BoxForm.Columns, 0.5).left.toOption,
      Some("expected an output of 1 × (4 + kinds) × boxes, got 1 × 3 × 4")
    )
    assertEquals(
      OnnxDetector.read(other, BoxForm.Rows, 0.5).left.toOption,
      Some("expected an output of 1 × boxes × 6, got 1 × 3 × 4")
    )
