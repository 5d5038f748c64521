#include "tests/bench/vtk.h"

#if defined(SGM_VTK)
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>

#endif

namespace sgm::bench {

#if defined(SGM_VTK)
VtkResult measureVtk(const float* values, const int (&corners)[3], Running running) {
    vtkNew<vtkFloatArray> array;
    // It takes a pointer to what may be written, and leaves it as it is; the last argument keeps it ours.
    array->SetArray(const_cast<float*>(values), vtkIdType{corners[0]} * corners[1] * corners[2], 1);
    vtkNew<vtkImageData> image;
    image->SetDimensions(corners[0], corners[1], corners[2]);
    image->GetPointData()->SetScalars(array);
    vtkNew<vtkFlyingEdges3D> filter;
    filter->SetInputData(image);
    filter->SetValue(0, 0.0);
    filter->ComputeNormalsOff();
    filter->ComputeGradientsOff();
    filter->ComputeScalarsOff();
    vtkSMPTools::Initialize(running.threads);
    const Stopwatch watch(running);
    filter->Update();
    return {watch.seconds(), static_cast<uint64_t>(filter->GetOutput()->GetNumberOfPolys())};
}
#else
VtkResult measureVtk(const float*, const int (&)[3], Running) { return {}; }
#endif

}  // namespace sgm::bench
