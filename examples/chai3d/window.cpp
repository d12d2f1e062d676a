// The scenes of CHAI3D in a window, while a loop of ebac renders them at 1 kHz to a simulated hand that the mouse leads.
#define GLFW_INCLUDE_NONE  // CHAI3D brings OpenGL
#include <GLFW/glfw3.h>
#include <graphics/CImage.h>
#include <graphics/COpenGLHeaders.h>
#include <lighting/CDirectionalLight.h>
#include <math/CMaths.h>
#include <resources/CFontCalibri20.h>
#include <widgets/CLabel.h>
#include <world/CShapeLine.h>
#include <world/CShapeSphere.h>

#include <atomic>
#include <cstdlib>
#include <ebac/sim/simulated_device.hpp>
#include <iostream>
#include <set>
#include <string>
#include <thread>

#include "haptic_device.hpp"
#include "led_hand.hpp"
#include "result.hpp"
#include "scene_list.hpp"

namespace {

constexpr std::array kLaws{"ebac", "direct", "tca", "tca-damped", "eba", "passivity-control"};
constexpr double kShown = 1;                     // s, over which the swing is measured
constexpr double kDistance = 0.32;               // m, from the camera to what it looks at
constexpr double kSeenHeight = 0.2;              // m, of the window at that distance
constexpr double kArrow = 3e-3;                  // m/N
constexpr float kSolid = 0.5F;                   // of a surface, so that the hand behind it is seen
constexpr std::chrono::microseconds kPass{500};  // between two passes of the haptic thread
const chai3d::cVector3d kLooked{0.03, 0, 0};     // m

struct Choice {
  std::size_t scene = 3, law = 0;  // of kScenes, kLaws
  double stiffness = 1e4;          // N/m
  double seconds = 0;              // s; 0: until the window is closed
  std::string picture;             // PNG of the last frame
};

/// A scene, the loop that renders it, and the haptic thread between them. What changes begins anew.
class Felt {
 public:
  explicit Felt(const Choice& choice) : wishes_(std::make_shared<chai::Wishes>()) {
    const ebac::Setup setup = chai::setup_of(1);
    const chai::RunOptions options{.device = setup.device,
                                   .timing = setup.timing,
                                   .loop = setup.loop,
                                   .stiffness = choice.stiffness,
                                   .rows = static_cast<std::size_t>(kShown / setup.timing.dt),
                                   .ring = true};
    using Device = chai::LedHand<ebac::SimulatedDevice>;
    auto runner = std::make_unique<chai::LoopRunner<Device, ebac::rt::MonotonicClock>>(
        Device(ebac::SimulatedDevice(setup), wishes_), options,
        chai::law_of(kLaws[choice.law], setup));
    device_ = std::make_shared<chai::HapticDevice>(std::move(runner), false);
    const chai::Scene& scene = chai::kScenes[choice.scene];
    scene.build(world_, choice.stiffness);
    tool_ = chai::add_tool(world_, device_, scene.tool);
    thread_ = std::thread([this] {
      while (goes_.load(std::memory_order_relaxed) && device_->running()) {
        chai::haptic_pass(world_, *tool_);
        std::this_thread::sleep_for(kPass);
      }
    });
  }
  ~Felt() {
    goes_.store(false, std::memory_order_relaxed);
    thread_.join();
    tool_->stop();
  }
  Felt(const Felt&) = delete;
  Felt& operator=(const Felt&) = delete;
  Felt(Felt&&) = delete;
  Felt& operator=(Felt&&) = delete;

  chai3d::cWorld& world() { return world_; }
  chai3d::cToolCursor& tool() { return *tool_; }
  void lead(const ebac::Axes& to) { wishes_->post(to); }
  bool running() const { return device_->running(); }
  const ebac::Trace& trace() const { return device_->trace(); }

 private:
  chai3d::cWorld world_;
  std::shared_ptr<chai::Wishes> wishes_;
  std::shared_ptr<chai::HapticDevice> device_;
  chai3d::cToolCursor* tool_;
  std::atomic<bool> goes_{true};
  std::thread thread_;
};

/// What is drawn of a scene, and the words in front of it.
class View {
 public:
  explicit View(Felt& felt)
      : felt_(&felt),
        camera_(new chai3d::cCamera(&felt.world())),
        wished_(new chai3d::cShapeSphere(0.003)),
        arrow_(new chai3d::cShapeLine()),
        words_(new chai3d::cLabel(chai3d::NEW_CFONT_CALIBRI_20())) {
    chai3d::cWorld& world = felt.world();
    world.m_backgroundColor.setWhite();
    for (unsigned i = 0; i < world.getNumChildren(); ++i) {
      if (world.getChild(i) != &felt.tool())
        world.getChild(i)->setTransparencyLevel(kSolid, true, true);
    }
    camera_->setUseMultipassTransparency(true);
    world.addChild(camera_);
    camera_->set(kLooked + chai3d::cVector3d(0, -kDistance, 0), kLooked, {0, 0, 1});
    camera_->setClippingPlanes(0.01, 10);
    camera_->setFieldViewAngleRad(2 * std::atan(kSeenHeight / 2 / kDistance));
    auto* light = new chai3d::cDirectionalLight(&world);
    world.addChild(light);
    light->setEnabled(true);
    light->setDir(0.5, 1, -1);
    felt.tool().setRadius(0.004, felt.tool().m_hapticPoint->getRadiusContact());
    felt.tool().m_hapticPoint->m_sphereProxy->m_material->setGreenDark();
    wished_->m_material->setPurpleViolet();
    world.addChild(wished_);
    arrow_->m_colorPointA.setRed();
    arrow_->m_colorPointB.setRed();
    arrow_->setLineWidth(4);
    world.addChild(arrow_);
    words_->m_fontColor.setBlack();
    camera_->m_frontLayer->addChild(words_);
  }

  void draw(int width, int height, const Choice& choice, const ebac::Axes& wish) {
    chai3d::cVector3d force;
    std::string text = std::string(chai::kScenes[choice.scene].name) + ", " + kLaws[choice.law] +
                       ", " + chai3d::cStr(choice.stiffness / 1e3, 1) + " kN/m; simulated\n";
    if (const std::size_t rows = felt_->trace().size(); rows > 0) {
      chai::Result found;
      chai::measure(felt_->trace(), found);
      const ebac::Sample last = felt_->trace().sample(rows - 1);
      for (int i = 0; i < 3; ++i) force(i) = -last.axis[static_cast<std::size_t>(i)].port.f_applied;
      text += "force " + chai3d::cStr(force.length(), 2) + " N, swing " +
              chai3d::cStr(1e3 * found.swing, 2) + " mm";
      if (found.fault != ebac::Fault::kNone)
        text += ", stopped by fault " + std::to_string(static_cast<int>(found.fault)) +
                ": R begins anew";
    }
    words_->setText(
        text +
        "\ndrag: lead the hand   1-4: scene   L: law   up, down: stiffness   R: again   Q: end");
    words_->setLocalPos(12, height - 70);
    wished_->setLocalPos(chai::to_chai(wish));
    const chai3d::cVector3d at = felt_->tool().getDeviceGlobalPos();
    arrow_->m_pointA = at;
    arrow_->m_pointB = at + kArrow * force;
    felt_->world().updateShadowMaps(false, false);
    camera_->renderView(width, height);
  }
  chai3d::cCamera& camera() { return *camera_; }

 private:
  Felt* felt_;
  // The world's.
  chai3d::cCamera* camera_;
  chai3d::cShapeSphere* wished_;
  chai3d::cShapeLine* arrow_;
  chai3d::cLabel* words_;
};

/// What keys and mouse change; the callbacks of GLFW write it.
struct Wanted {
  Choice choice;
  ebac::Axes wish{0.04, 0.006, 0.004};  // m
  bool dragged = false, anew = false, over = false;
};

void pressed(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  auto& wanted = *static_cast<Wanted*>(glfwGetWindowUserPointer(window));
  Choice& choice = wanted.choice;
  wanted.anew = true;
  if (key >= GLFW_KEY_1 && key < GLFW_KEY_1 + static_cast<int>(chai::kScenes.size()))
    choice.scene = static_cast<std::size_t>(key - GLFW_KEY_1);
  else if (key == GLFW_KEY_L)
    choice.law = (choice.law + 1) % kLaws.size();
  else if (key == GLFW_KEY_UP)
    choice.stiffness = std::min(5e4, 2 * choice.stiffness);
  else if (key == GLFW_KEY_DOWN)
    choice.stiffness = std::max(100.0, choice.stiffness / 2);
  else if (key == GLFW_KEY_Q || key == GLFW_KEY_ESCAPE)
    wanted.over = true;
  else if (key != GLFW_KEY_R)
    wanted.anew = false;
}

void clicked(GLFWwindow* window, int button, int action, int) {
  if (button == GLFW_MOUSE_BUTTON_LEFT)
    static_cast<Wanted*>(glfwGetWindowUserPointer(window))->dragged = action == GLFW_PRESS;
}

void moved(GLFWwindow* window, double u, double v) {
  auto& wanted = *static_cast<Wanted*>(glfwGetWindowUserPointer(window));
  if (!wanted.dragged) return;
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  const double pixel = kSeenHeight / height;
  wanted.wish[0] = kLooked.x() + (u - width / 2.0) * pixel;
  wanted.wish[2] = kLooked.z() - (v - height / 2.0) * pixel;
}

int usage(const char* name) {
  std::cerr << "usage: " << name
            << " [--scene NAME] [--law NAME] [--stiffness N_PER_M] [--seconds S] [--picture "
               "FILE.png]\n  scenes:";
  for (const chai::Scene& scene : chai::kScenes) std::cerr << " \"" << scene.name << '"';
  std::cerr << "\n  laws:";
  for (const char* law : kLaws) std::cerr << ' ' << law;
  std::cerr << "\n  stiffness: 100 to 50000 N/m; without --seconds until the window is closed\n";
  return 2;
}

template <class List, class Name>
bool find(const List& list, std::string_view name, Name of, std::size_t& found) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (of(list[i]) != name) continue;
    found = i;
    return true;
  }
  return false;
}

bool parse(int count, char** arguments, Choice& choice) {
  for (int i = 1; i < count; i += 2) {
    if (i + 1 == count) return false;
    const std::string_view name = arguments[i];
    const char* value = arguments[i + 1];
    if (name == "--scene") {
      if (!find(chai::kScenes, value, [](const auto& scene) { return scene.name; }, choice.scene))
        return false;
    } else if (name == "--law") {
      if (!find(kLaws, value, [](const char* law) { return std::string_view(law); }, choice.law))
        return false;
    } else if (name == "--stiffness") {
      choice.stiffness = std::atof(value);
    } else if (name == "--seconds") {
      choice.seconds = std::atof(value);
    } else if (name == "--picture") {
      choice.picture = value;
    } else {
      return false;
    }
  }
  return choice.stiffness >= 100 && choice.stiffness <= 5e4 && choice.seconds >= 0;
}

/// Writes what the camera sees; whether anything is in it.
bool take_picture(chai3d::cCamera& camera, const std::string& file) {
  const chai3d::cImagePtr image = chai3d::cImage::create();
  camera.copyImageBuffer(image);
  std::set<std::array<unsigned char, 3>> colours;
  for (unsigned x = 0; x < image->getWidth(); x += 4) {
    for (unsigned y = 0; y < image->getHeight(); y += 4) {
      chai3d::cColorb colour;
      image->getPixelColor(x, y, colour);
      colours.insert({colour.getR(), colour.getG(), colour.getB()});
    }
  }
  return image->saveToFile(file) && colours.size() > 10;
}

int show(GLFWwindow* window, const Choice& choice) {
  Wanted wanted{.choice = choice};
  glfwSetWindowUserPointer(window, &wanted);
  glfwSetKeyCallback(window, pressed);
  glfwSetMouseButtonCallback(window, clicked);
  glfwSetCursorPosCallback(window, moved);
  bool drawn = true;
  while (!wanted.over) {
    wanted.anew = false;
    Felt felt(wanted.choice);
    View view(felt);
    const double begun = glfwGetTime();
    int width = 0, height = 0;
    while (!wanted.anew && !wanted.over) {
      felt.lead(wanted.wish);
      glfwGetFramebufferSize(window, &width, &height);
      view.draw(width, height, wanted.choice, wanted.wish);
      glfwSwapBuffers(window);
      glfwPollEvents();
      if (glfwWindowShouldClose(window) != 0 ||
          (choice.seconds > 0 && glfwGetTime() - begun > choice.seconds))
        wanted.over = true;
    }
    if (!wanted.over || choice.picture.empty()) continue;
    view.draw(width, height, wanted.choice, wanted.wish);
    drawn = take_picture(view.camera(), choice.picture);
    if (!drawn) std::cerr << "no picture, or nothing on it: " << choice.picture << '\n';
  }
  return drawn ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  Choice choice;
  if (!parse(count, arguments, choice)) return usage(arguments[0]);
  if (glfwInit() == 0) {
    std::cerr
        << "no display: chai3d_window needs one; chai3d_program runs the same scenes without\n";
    return 3;
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 2);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
  GLFWwindow* window = glfwCreateWindow(1000, 600, "ebac in CHAI3D; simulated", nullptr, nullptr);
  if (window == nullptr) {
    std::cerr << "the display has no OpenGL 2.1, which CHAI3D draws with\n";
    glfwTerminate();
    return 3;
  }
  glfwMakeContextCurrent(window);
  glfwSwapInterval(1);
  int code = 3;
  if (glewInit() == GLEW_OK)
    code = show(window, choice);
  else
    std::cerr << "OpenGL could not be loaded by GLEW\n";
  glfwDestroyWindow(window);
  glfwTerminate();
  return code;
}
