#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>

#include "bind.hpp"
#include "ebac/gastroscope/procedure.hpp"
#include "ebac/gastroscope/slave.hpp"
#include "ebac/sim/setup.hpp"
#include "held_solid.hpp"
#include "others_run.hpp"
#include "sweep.hpp"

namespace ebac::python {

namespace {

using namespace ebac::gastroscope;
using Triple = std::array<double, 3>;
using LumenPtr = std::shared_ptr<const Lumen>;

Triple triple(const Vec& v) { return {v.x, v.y, v.z}; }
Vec vec(const Triple& v) { return {v[0], v[1], v[2]}; }

LumenPtr lumen_of(const PatientParams& patient, const std::vector<Triple>& points,
                  const std::vector<double>& radii, const std::optional<HeldSolid>& wall) {
  if (points.empty() && radii.empty() && !wall) return std::make_shared<Lumen>(patient);
  std::vector<Vec> line;
  line.reserve(points.size());
  for (const Triple& point : points) line.push_back(vec(point));
  return std::make_shared<Lumen>(patient, line, radii, wall ? wall->solid : nullptr);
}

Values landmarks_of(const Lumen& lumen) {
  const Landmarks& l = lumen.landmarks();
  using namespace py::literals;
  return py::dict("oesophagus"_a = l.oesophagus, "cardia"_a = l.cardia, "stomach"_a = l.stomach,
                  "pylorus"_a = l.pylorus, "behind"_a = l.behind, "end"_a = l.end);
}

/// The slave with its own lumen, for a look at it tick by tick.
struct OwnSlave {
  OwnSlave(const ScopeParams& scope, LumenPtr way, double start)
      : lumen(std::move(way)), slave(scope, *lumen, start) {}
  LumenPtr lumen;
  Slave slave;
  double t = 0;
};

Values state_of(const Slave& s) {
  using namespace py::literals;
  std::vector<Triple> tube;
  for (std::size_t i = 0; i + 1 < s.tube().nodes(); ++i) tube.push_back(triple(s.tube().node(i)));
  return py::dict("at"_a = triple(s.camera().at), "ahead"_a = triple(s.camera().camera.z),
                  "right"_a = triple(s.camera().camera.x), "place"_a = s.place(),
                  "inserted"_a = s.inserted(), "bend"_a = std::array{s.bend().x, s.bend().y},
                  "tip_force"_a = s.tip_force(), "section_force"_a = s.section_force(),
                  "tube_force"_a = s.tube_force(), "stored"_a = s.stored(), "tube"_a = tube,
                  "bag"_a = triple(s.motion().bag));
}

Triple step_of(OwnSlave& own, const Triple& command, double rotation, double dt) {
  own.t += dt;
  const ebac::gastroscope::Answer answer =
      own.slave.step({command[0], rotation, command[1], command[2]}, own.t, dt);
  return {answer.push, answer.torque_x, answer.torque_y};
}

void bind_parts(py::module_& m) {
  bind_fields<ScopeParams>(m, "Scope", "A gastroscope whose four axes are driven by motors.");
  bind_fields<PatientParams>(m, "Patient", "The way from the teeth to behind the pylorus.");
  bind_fields<MasterParams>(m, "Master",
                            "How the joystick commands the gastroscope and is pushed back.");
  bind_fields<PhysicianParams>(m, "Physician", "A simulated physician, who steers by the picture.");
  bind_fields<gastroscope::Target>(m, "Polyp", "A target on the wall.");
  m.def(
      "_camera",
      [](double bend_x, double bend_y, double section, double tip) {
        const SectionPoint p = camera_of({bend_x, bend_y}, section, tip);
        const CameraJacobian j = jacobian_of({bend_x, bend_y}, section, tip);
        return std::tuple(triple(p.at), triple(p.camera.x), triple(p.camera.y), triple(p.camera.z),
                          std::array{triple(j[0]), triple(j[1]), triple(j[2]), triple(j[3])});
      },
      py::arg("bend_x"), py::arg("bend_y"), py::arg("section"), py::arg("tip"));
  py::class_<Lumen, std::shared_ptr<Lumen>>(m, "_Lumen")
      .def(py::init([](const PatientParams& patient, const std::vector<Triple>& points,
                       const std::vector<double>& radii, const std::optional<HeldSolid>& wall) {
             return std::const_pointer_cast<Lumen>(lumen_of(patient, points, radii, wall));
           }),
           py::arg("patient"), py::arg("points"), py::arg("radii"), py::arg("wall"))
      .def("landmarks", &landmarks_of)
      .def(
          "at",
          [](const Lumen& lumen, double s, double t, const Triple& bag) {
            const Frame f = lumen.frame(s);
            return std::tuple(triple(lumen.middle(s, {t, vec(bag)})), triple(f.x), triple(f.y),
                              triple(f.z), lumen.radius(s, t));
          },
          py::arg("s"), py::arg("t"), py::arg("bag") = Triple{})
      .def(
          "near",
          [](const Lumen& lumen, const Triple& x, double radius, double t, int station) {
            Along hint{.station = station};
            const WallNear near = lumen.near(vec(x), radius, {t, {}}, hint);
            return std::tuple(near.s, near.depth, triple(near.way));
          },
          py::arg("x"), py::arg("radius"), py::arg("t"), py::arg("station"));
  py::class_<OwnSlave>(m, "_Slave")
      .def(py::init([](const ScopeParams& scope, const std::shared_ptr<Lumen>& lumen,
                       double start) { return OwnSlave(scope, lumen, start); }),
           py::arg("scope"), py::arg("lumen"), py::arg("start"))
      .def("step", &step_of, py::arg("command"), py::arg("rotation"), py::arg("dt"))
      .def("state", [](const OwnSlave& own) { return state_of(own.slave); });
}

void bind_navigation(py::module_& m) {
  py::class_<Navigation>(m, "_Navigation")
      .def(py::init<const Procedure&, const Setup&, const AnyLaw&>(), py::arg("procedure"),
           py::arg("setup"), py::arg("law"))
      .def(
          "advance",
          [](Navigation& run, int ticks) {
            const OthersRun release;
            for (int i = 0; i < ticks && run.step(); ++i) {
            }
          },
          py::arg("ticks"))
      .def_property_readonly("ended", &Navigation::ended)
      .def("row", [](Navigation& run) { return values_of(run.row()); })
      .def("findings", [](const Navigation& run) { return values_of(run.findings()); })
      .def_static("units", &units_of<Findings>)
      .def("state", [](const Navigation& run) { return state_of(run.slave()); });
}

}  // namespace

void bind_gastroscope(py::module_& m) {
  bind_parts(m);
  py::class_<Procedure>(m, "_Procedure")
      .def(py::init([](const ScopeParams& scope, const std::shared_ptr<Lumen>& lumen,
                       const MasterParams& master, const PhysicianParams& physician,
                       const std::vector<gastroscope::Target>& targets, double start) {
             return Procedure{scope, lumen, master, physician, targets, start};
           }),
           py::kw_only(), py::arg("scope"), py::arg("lumen"), py::arg("master"),
           py::arg("physician"), py::arg("targets"), py::arg("start"));
  bind_navigation(m);
  m.def(
      "_run_procedure",
      [](const Procedure& procedure, const Setup& setup, const AnyLaw& law, int every,
         SweepProgress& progress) {
        std::vector<ProcedureRow> rows;
        Findings found;
        {
          const OthersRun release;
          found = run_procedure(procedure, setup, law, every, progress, &rows);
        }
        Values columns;
        add_columns<ProcedureRow>(columns, rows,
                                  [](const ProcedureRow& r) -> const ProcedureRow& { return r; });
        return std::pair(values_of(found), columns);
      },
      py::arg("procedure"), py::arg("setup"), py::arg("law"), py::arg("every"),
      py::arg("progress"));
  m.def(
      "_run_procedures",
      [](const std::vector<const Procedure*>& procedures, const std::vector<const Setup*>& setups,
         const std::vector<const AnyLaw*>& laws, int threads, SweepProgress& progress) {
        require_all(procedures, "procedures");
        require_all(setups, "setups");
        require_all(laws, "laws");
        if (procedures.size() != setups.size() || procedures.size() != laws.size())
          throw std::invalid_argument("procedures, setups, laws: give one of each for every run");
        std::vector<Findings> found;
        {
          const OthersRun release;
          found = run_procedures(procedures, setups, laws, threads, progress);
        }
        Values columns;
        add_columns<Findings>(columns, found,
                              [](const Findings& f) -> const Findings& { return f; });
        return columns;
      },
      py::arg("procedures"), py::arg("setups"), py::arg("laws"), py::arg("threads"),
      py::arg("progress"));
  m.def("_procedure_fields", [] {
    std::vector<std::tuple<std::string, std::string, std::string>> all;
    for (const FieldRow& f : field_table<ProcedureRow>().rows)
      all.emplace_back(f.name, f.unit, f.meaning);
    return all;
  });
}

}  // namespace ebac::python
